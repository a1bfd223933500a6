#pragma once
// Bodies near each other on the device: the lists that the kernels of contact walk over, which the host makes
// again when bodies have moved, and the contacts made of them.
#include <cstdint>
#include <memory>

#include "gpu/buffer.h"
#include "gpu/pass.h"
#include "gpu_solver/contact_lists.h"
#include "gpu_solver/layout.h"

namespace aspic {

class ContactBuffers {
 public:
  /// Makes what stays; nothing at all for a model whose bodies do not touch. Errors as Buffer::create().
  Status build(gl::Context& context, const Model& model);

  bool any() const { return lists_ != nullptr; }
  /// Whether something may touch while the lists hold, so that passes are needed.
  bool acts() const { return group_count_ > 0; }

  /// The state, or what belongs to it, is another one: refresh() before the next step.
  void forget() { fresh_ = false; }
  bool fresh() const { return fresh_ || !any(); }
  void set_model(const Model& model);
  const Model& model() const { return *model_; }
  /// Makes the lists for the state in a buffer. Errors as ContactLists::make() and Buffer::create().
  Status refresh(const gl::Buffer& state);
  /// After how many steps lists may not hold any more, by the particles' speeds when they were made: so many
  /// are worth being queued.
  std::uint64_t patience() const { return patience_; }
  /// That many have passed.
  void held(std::uint64_t steps);
  /// The square of how far a particle may be from where it was [m²], for a look on the device.
  float most() const;
  /// Until when since the initial state bodies that overlapped in it are eased apart [s].
  double eased_until() const { return lists_->eased_until(); }
  bool has_friction() const {
    return lists_->has_friction();
  }  ///< whether any body has friction against others

  /// Candidate groups, particles listed and places, for as many invocations.
  std::uint32_t group_count() const { return group_count_; }
  std::uint32_t listed_count() const { return listed_count_; }
  std::uint32_t place_count() const { return place_count_; }
  gl::Binding triangles() const { return {BINDING_CONTACT_TRIANGLES, &triangles_}; }
  gl::Binding candidate_groups() const { return {BINDING_CANDIDATE_GROUPS, &candidate_groups_}; }
  gl::Binding words() const { return {BINDING_CONTACT_WORDS, &words_}; }
  gl::Binding records() const { return {BINDING_CONTACT_RECORDS, &records_}; }
  gl::Binding listed() const { return {BINDING_CONTACT_LISTED, &listed_}; }
  gl::Binding places() const { return {BINDING_CONTACT_PLACES, &places_}; }

  /// Bytes held beyond those after build().
  std::uint64_t grown_bytes() const;

 private:
  Status fit(gl::Buffer& buffer, const char* name, std::uint64_t bytes);

  gl::Context* context_ = nullptr;
  const Model* model_ = nullptr;
  std::unique_ptr<ContactLists> lists_;
  bool fresh_ = false;
  std::uint32_t group_count_ = 0, listed_count_ = 0, place_count_ = 0;
  std::uint64_t patience_ = 1;
  gl::Buffer triangles_, candidate_groups_, words_, records_, listed_, places_;
};

}  // namespace aspic
