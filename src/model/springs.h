#pragma once
// The springs of a model, whether it lists them or a lattice implies them.
#include <array>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

#include "model/model.h"

namespace aspic {

/// Springs of a model in ascending order of (a, b), made as they are needed; for one loop at a time:
/// `for (const Spring& s : springs_of(model))`. The model must outlive it.
class SpringRange {
 public:
  using Block = std::span<const Spring>;

  class Iterator {
   public:
    explicit Iterator(SpringRange& range) : range_(range), block_(range.next_block()) {}
    const Spring& operator*() const { return block_[at_]; }
    Iterator& operator++() {
      if (++at_ == block_.size()) {
        block_ = range_.next_block();
        at_ = 0;
      }
      return *this;
    }
    bool operator==(std::default_sentinel_t) const { return block_.empty(); }

   private:
    SpringRange& range_;
    Block block_;
    std::size_t at_ = 0;
  };

  SpringRange(const Model& model, std::uint32_t first_particle, std::uint32_t end_particle);
  Iterator begin();
  std::default_sentinel_t end() const { return {}; }

 private:
  static constexpr std::size_t most_directions = upper_directions().size();

  Block next_block();
  void enter(const Body& body);
  Block springs_of_next_particle();

  const Model& model_;
  std::uint32_t first_, end_;
  std::vector<Spring>::const_iterator listed_;
  std::vector<Body>::const_iterator body_;
  // The lattice at hand, none between lattices; the next particle and its place.
  const Lattice* box_ = nullptr;
  int i_ = 0, j_ = 0, k_ = 0;
  std::uint32_t particle_ = 0;
  std::array<Spring, most_directions> ups_ = {};  // by direction, with b the step to the upper end
  std::array<Spring, most_directions> buffer_ = {};
};

/// All springs of a model.
SpringRange springs_of(const Model& model);
/// Those whose lower end is one of `count` particles from `first` on; a body lies in this range completely or
/// not at all.
SpringRange springs_of(const Model& model, std::uint32_t first, std::uint32_t count);

/// All springs as a list, 12 bytes each.
std::vector<Spring> all_springs(const Model& model);

/// How many springs there are, without a walk over them.
std::uint64_t spring_count(const Model& model);
/// The same by spring class.
std::vector<std::uint64_t> springs_by_class(const Model& model);

/// Springs of a lattice's particles, of which `first` is the first, sorted by (a, b).
std::vector<Spring> springs_of(const Lattice& lattice, std::uint32_t first, std::uint32_t first_class);

/// Puts all springs of the model and its surfaces into lists and takes the lattices from its bodies: for
/// those who change some of the springs.
void list_springs(Model& model);

}  // namespace aspic
