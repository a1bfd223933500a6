#include "gpu/fence.h"

#include <glad/gl.h>

#include "gpu/current.h"

namespace aspic::gl {
namespace {

constexpr GLuint64 look_ns = 100'000'000;
constexpr int looks_per_second = 10;

}  // namespace

void DeleteFence::operator()(void* sync) const {
  context->dispose({sync});
}

Fence fence(Context& context) {
  Fence made(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0), {&context});
  glFlush();
  return made;
}

bool passed(Context& context, const Fence& fence) {
  if (context.strikes(Fault::late)) return false;
  return glClientWaitSync(static_cast<GLsync>(fence.get()), 0, 0) != GL_TIMEOUT_EXPIRED;
}

Status wait_for(Context& context, const Fence& fence) {
  const Current here(context);
  ASPIC_CHECK(here.status());
  const bool answers = !context.strikes(Fault::no_answer);
  const auto sync = static_cast<GLsync>(fence.get());
  for (int n = 0; answers && n < longest_wait * looks_per_second; ++n) {
    const GLenum state = glClientWaitSync(sync, GL_SYNC_FLUSH_COMMANDS_BIT, look_ns);
    if (state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED) return {};
    if (context.lost() || state == GL_WAIT_FAILED) return context.lost_error();
  }
  context.silent_ = true;
  return context.lost_error();
}

}  // namespace aspic::gl
