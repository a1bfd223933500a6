#pragma once
// The lists that kernels of contact between bodies walk over (shaders/compute/terms/body_contact.glsl):
// points with the triangles near them, and for each particle the candidate groups that may act on it. Found
// on the host, for as long as bodies move little.
#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "collision/candidate_lists.h"
#include "gpu_solver/layout.h"
#include "model/contact_surface.h"

namespace aspic {

class ContactLists {
 public:
  /// Of a model whose has_body_contact().
  explicit ContactLists(const Model& model);
  ContactLists(const ContactLists&) = delete;
  ContactLists& operator=(const ContactLists&) = delete;

  /// Makes the lists for particles at these places. Error (scene_rejected): more meets in one place than a
  /// kernel may walk over.
  Status make(std::span<const layout::Particle> particles);

  /// For the device: corners and sides of triangles, which stay; the rest as made last.
  std::vector<layout::uvec4> triangles() const;
  std::span<const layout::CandidateGroup> candidate_groups() const { return candidate_groups_; }
  std::span<const std::uint32_t> words() const { return words_; }
  std::span<const layout::ContactParticle> listed() const { return listed_; }
  /// Bits of the places of all particles of surfaces; w: which particle.
  std::span<const layout::uvec4> places() const { return built_; }
  /// Until when since the initial state bodies that overlapped in it are eased apart [s]; 0 if none did.
  double eased_until() const { return eased_until_; }
  /// Whether any body has friction against others.
  bool has_friction() const;
  /// How far a particle may move from there [m].
  double displacement_limit() const { return near_.displacement_limit(); }

 private:
  struct Named {
    std::uint32_t particle, candidate_group;
    bool visits;
  };
  layout::CandidateGroup group_of(const collision::CandidateGroup& near) const;
  Status list_particles();

  ContactSurfaces surfaces_;
  ContactSettings contact_;
  collision::CandidateLists near_;
  double ahead_step_;  // of implicit Euler; else 0 [s]
  double eased_until_ = 0.0;
  struct Start {
    std::uint32_t point, body;
    float distance;
  };
  std::vector<Start> starts_;  // of bodies that overlap in the initial state; ascending
  std::vector<layout::CandidateGroup> candidate_groups_;
  std::vector<std::uint32_t> words_;
  std::vector<layout::ContactParticle> listed_;
  std::vector<layout::uvec4> built_;
};

}  // namespace aspic
