#include "gpu/device_info.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "base/printable.h"

namespace aspic::gl {
namespace {

std::string text_of(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text ? text : "unknown";
}

template <class T>
T integer(GLenum name) {
  GLint64 value = 0;
  glGetInteger64v(name, &value);
  return static_cast<T>(std::max<GLint64>(value, 0));
}

std::array<std::uint32_t, 3> three(GLenum name) {
  std::array<std::uint32_t, 3> result;
  for (GLuint i = 0; i < 3; ++i) {
    GLint value = 0;
    glGetIntegeri_v(name, i, &value);
    result[i] = static_cast<std::uint32_t>(value);
  }
  return result;
}

}  // namespace

bool is_software_renderer(std::string_view renderer) {
  std::string lower(renderer);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  // The names under which Mesa, Google's, Microsoft's and Apple's rasterizers present themselves.
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "lavapipe", "swiftshader", "software rasterizer",
                           "swr (", "gdi generic", "basic render", "apple software"})
    if (lower.find(name) != std::string::npos) return true;
  return false;
}

DeviceInfo query_device_info() {
  DeviceInfo info;
  info.vendor = text_of(GL_VENDOR);
  info.renderer = text_of(GL_RENDERER);
  info.version = text_of(GL_VERSION);
  info.glsl_version = text_of(GL_SHADING_LANGUAGE_VERSION);
  info.is_software = is_software_renderer(info.renderer);
  info.limits.storage_block_bytes = integer<std::uint64_t>(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  // OpenGL has no limit to ask for.
  const bool mesa = info.version.find("Mesa") != std::string::npos;
  info.limits.buffer_bytes = mesa ? std::numeric_limits<std::uint32_t>::max()
                                  : static_cast<std::uint64_t>(std::numeric_limits<GLsizeiptr>::max());
  info.limits.uniform_block_bytes = integer<std::uint64_t>(GL_MAX_UNIFORM_BLOCK_SIZE);
  info.limits.compute_storage_blocks = integer<std::uint32_t>(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS);
  info.limits.vertex_storage_blocks = integer<std::uint32_t>(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS);
  info.limits.group_invocations = integer<std::uint32_t>(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
  info.limits.group_count = three(GL_MAX_COMPUTE_WORK_GROUP_COUNT);
  info.limits.group_size = three(GL_MAX_COMPUTE_WORK_GROUP_SIZE);
  info.limits.shared_bytes = integer<std::uint32_t>(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE);
  info.limits.storage_offset_alignment = integer<std::uint32_t>(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT);
  info.limits.uniform_offset_alignment = integer<std::uint32_t>(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT);
  return info;
}

std::vector<std::string> describe(const DeviceInfo& info) {
  const DeviceLimits& l = info.limits;
  return {
      fmt::format("renderer        {}{}", info.renderer, info.is_software ? " (software)" : ""),
      fmt::format("vendor          {}", info.vendor),
      fmt::format("OpenGL          {}", info.version),
      fmt::format("GLSL            {}", info.glsl_version),
      fmt::format("context         {}{}{}", info.platform, info.debug ? ", debug" : "",
                  info.robust ? ", robust" : ", does not report a lost device"),
      fmt::format("storage block   {} at most, {} per compute shader, {} per vertex shader",
                  human_bytes(l.storage_block_bytes), l.compute_storage_blocks, l.vertex_storage_blocks),
      fmt::format("uniform block   {} at most", human_bytes(l.uniform_block_bytes)),
      fmt::format("work groups     {} x {} x {} at most, of {} x {} x {} and {} invocations at most",
                  l.group_count[0], l.group_count[1], l.group_count[2], l.group_size[0], l.group_size[1],
                  l.group_size[2], l.group_invocations),
      fmt::format("shared memory   {} per work group", human_bytes(l.shared_bytes)),
  };
}

}  // namespace aspic::gl
