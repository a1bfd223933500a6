#include "gpu_solver/ball_face_passes.h"

#include <algorithm>

#include "model/ball_faces.h"

namespace aspic {
namespace {

using gl::Binding;
using gl::Buffer;
using gl::ReadBy;

static_assert(FACE_BLOCK == face_block);

/// By BallFacePasses::Kernel.
constexpr KernelRow face_kernels[] = {{"compute/ball_face_boxes.comp", "balls: boxes of faces"},
                                      {"compute/ball_face_find.comp", "balls: find faces"},
                                      {"compute/ball_face_tally.comp", "balls: count faces"},
                                      {"compute/ball_face_impulse.comp", "balls: impulses of faces"},
                                      {"compute/ball_face_gather.comp", "balls: sum faces"}};

/// What the kernels read: how many bodies and blocks; of each body its first block, how many, and whether it
/// is closed; then the triangles, those of each body filled up to whole blocks by its last one.
struct FaceRows {
  std::vector<layout::uvec4> rows;
  std::uint32_t bodies = 0, blocks = 0;
};
FaceRows rows_of(const Model& model) {
  const BallFaces faces = ball_faces(model);
  FaceRows made;
  made.rows.emplace_back();
  made.bodies = static_cast<std::uint32_t>(faces.bodies.size());
  for (const FacesOfBody& body : faces.bodies) {
    const std::uint32_t blocks = (body.triangle_count + face_block - 1) / face_block;
    made.rows.push_back({made.blocks, blocks, body.closed ? 1u : 0u, 0});
    made.blocks += blocks;
  }
  made.rows[0] = {made.bodies, made.blocks, 0, 0};
  std::size_t row = 0;
  for (const FacesOfBody& body : faces.bodies) {
    for (std::uint32_t n = 0; n < made.rows[1 + row].y * face_block; ++n) {
      const auto& corner = faces.triangles[body.first_triangle + std::min(n, body.triangle_count - 1)];
      made.rows.push_back({corner[0], corner[1], corner[2], 0});
    }
    ++row;
  }
  return made;
}

}  // namespace

std::uint64_t ball_face_bytes(const Model& model) {
  if (!balls_meet_faces(model)) return 0;
  const FaceRows faces = rows_of(model);
  const std::uint64_t balls = model.ball_count();
  return faces.rows.size() * sizeof(layout::uvec4) + 2 * faces.blocks * sizeof(layout::vec4) +
         balls * faces.bodies * sizeof(layout::BallFacePair) +
         (balls + model.particle_count()) * sizeof(layout::BallFaceCount);
}

Status BallFacePasses::build(gl::Context& context, const Model& model, const KernelOptions& kernels,
                             const std::vector<Binding>& bindings) {
  if (!balls_meet_faces(model)) return {};
  const FaceRows faces = rows_of(model);
  block_count_ = faces.blocks;
  body_count_ = model.ball_count() + model.particle_count();
  pair_count_ = model.ball_count() * faces.bodies;
  const auto make = [&](Buffer& buffer, const char* name, std::uint64_t bytes) -> Status {
    ASPIC_TRY(buffer, Buffer::create(context, name, bytes));
    return {};
  };
  ASPIC_TRY(faces_, Buffer::of(context, "faces for balls", faces.rows));
  ASPIC_CHECK(make(boxes_, "boxes of faces", 2 * std::uint64_t{block_count_} * sizeof(layout::vec4)));
  ASPIC_CHECK(make(pairs_, "balls on faces",
                   std::uint64_t{model.ball_count()} * faces.bodies * sizeof(layout::BallFacePair)));
  ASPIC_CHECK(make(counts_, "counts of balls on faces", body_count_ * sizeof(layout::BallFaceCount)));
  std::vector<Binding> all = bindings;
  all.insert(all.end(), {{BINDING_BALL_FACES, &faces_},
                         {BINDING_BALL_FACE_BOXES, &boxes_},
                         {BINDING_BALL_FACE_PAIRS, &pairs_},
                         {BINDING_BALL_FACE_COUNTS, &counts_}});
  for (std::size_t k = 0; k < kernel_count; ++k) {
    ASPIC_TRY(programs_[k], kernels.start(face_kernels[k].path));
    passes_[k].emplace(*programs_[k], all, ReadBy::compute_pass);
  }
  return {};
}

std::vector<std::string> BallFacePasses::pass_names() {
  return titles_of(face_kernels);
}

void BallFacePasses::dispatch(Kernel kernel, std::uint32_t items, std::span<const Binding> states,
                              ReadBy readers) const {
  passes_[kernel]->dispatch_for(items, states, readers);
  if (profiler_) profiler_->mark(first_kind_ + kernel);
}

void BallFacePasses::begin_step(std::uint32_t step, std::uint32_t parity) const {
  if (!any()) return;
  for (const auto& program : programs_) {
    program->set(LOCATION_STEP, step);
    program->set(LOCATION_BALL_PARITY, parity);
  }
}

void BallFacePasses::queue_find(std::span<const Binding> states) const {
  if (!any()) return;
  dispatch(boxes, block_count_, states);
  dispatch(find, std::max(pair_count_, body_count_), states);
}

void BallFacePasses::queue_meet(std::span<const Binding> states, ReadBy last) const {
  if (!any()) return;
  for (const std::uint32_t phase : {BALL_PHASE_FACES, BALL_PHASE_FACE_POSITIONS}) {
    for (const Kernel kernel : {tally, impulse, gather}) programs_[kernel]->set(LOCATION_BALL_PHASE, phase);
    dispatch(tally, pair_count_, states);
    dispatch(impulse, pair_count_, states);
    dispatch(gather, body_count_, states,
             phase == BALL_PHASE_FACE_POSITIONS ? last : ReadBy(ReadBy::compute_pass));
  }
}

}  // namespace aspic
