// The contact search of the cpu and gpu backends against the definition, which the reference follows: the
// same contacts to every bit, however bodies move and however long lists are kept.
#include "collision/contact_search.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <bit>
#include <random>
#include <utility>
#include <vector>

#include "cpu_reference/bodies_in_contact.h"

namespace aspic::collision::moving {
namespace {

using V = Vector<float>;
using Definition = reference::BodyContact<float>;
using test::cube_of;
using test::spacing;

/// Every bit of the contacts at a place of a step.
template <class Contact>
std::vector<std::uint32_t> bits(Contact& contact, const Field<float>& x, const Field<float>& v) {
  std::vector<std::uint32_t> all;
  contact.find({components(x.data()), components(v.data()), 3});
  for (const ContactPoint<float>& point : contact.contacts()) {
    all.insert(all.end(), {point.point, point.triangle});
    for (const float number : {point.n.x(), point.n.y(), point.n.z(), point.d, point.normal_force,
                               point.weight[0], point.weight[2], point.weight[3], point.weight[4]})
      all.push_back(std::bit_cast<std::uint32_t>(number));
  }
  return all;
}

V random_vector(std::mt19937& random, double size) {
  std::normal_distribution<double> some(0.0, 1.0);
  return rounded<float>({size * some(random), size * some(random), size * some(random)});
}

/// How bodies move in some steps, by step and in spacings.
struct Motion {
  const char* what;
  double drift, turn, strain, noise, together = 0.0;
  double approach = 0.0;  ///< of all bodies towards the origin, from half a spacing farther apart
};

/// Moves each body of the model as one, strains it about its middle and shakes its particles.
class Mover {
 public:
  Mover(const Model& model, unsigned seed) : model_(model), random_(seed) {}
  /// Moves all bodies away from the origin [m].
  void part(Field<float>& x, double by) const {
    for (const Body& body : model_.bodies) {
      auto own = x.middleCols(static_cast<Eigen::Index>(body.first_particle),
                              static_cast<Eigen::Index>(body.particle_count));
      const V middle = own.rowwise().mean();
      if (middle.norm() > 0.1f) own.colwise() += V(static_cast<float>(by) * middle.normalized());
    }
  }
  void turn_round(const Motion& motion) {
    together_ = random_vector(random_, motion.together * spacing);
    ways_.clear();
    for (std::size_t n = 0; n < model_.bodies.size(); ++n)
      ways_.push_back({random_vector(random_, motion.drift * spacing),
                       V(random_vector(random_, 1.0)).normalized(), random_vector(random_, motion.strain)});
  }
  void move(Field<float>& x, const Motion& motion) {
    for (std::size_t b = 0; b < ways_.size(); ++b) {
      const auto& [drift, axis, strain] = ways_[b];
      auto own = x.middleCols(static_cast<Eigen::Index>(model_.bodies[b].first_particle),
                              static_cast<Eigen::Index>(model_.bodies[b].particle_count));
      const V middle = own.rowwise().mean();
      const Eigen::Matrix3f turned =
          Eigen::AngleAxisf(static_cast<float>(motion.turn), axis).toRotationMatrix();
      for (Eigen::Index i = 0; i < own.cols(); ++i) {
        const V from = own.col(i) - middle;
        // Back towards the others, or away with them.
        own.col(i) = V(0.999f * middle + drift + together_ + turned * (from + V(strain.cwiseProduct(from))) +
                       random_vector(random_, motion.noise * spacing));
      }
    }
  }

 private:
  struct Way {
    V drift, axis, strain;
  };
  const Model& model_;
  std::mt19937 random_;
  V together_ = V::Zero();
  std::vector<Way> ways_;
};

class ContactSearches : public testing::TestWithParam<Motion> {};
INSTANTIATE_TEST_SUITE_P(
    Moving, ContactSearches,
    testing::Values(Motion{"rest", 0.0, 0.0, 0.0, 1e-6}, Motion{"drift", 3e-3, 0.0, 0.0, 1e-4},
                    Motion{"turn", 1e-3, 5e-3, 0.0, 1e-4}, Motion{"strain", 1e-3, 1e-3, 2e-3, 1e-4},
                    Motion{"shake", 1e-3, 1e-3, 0.0, 5e-3}, Motion{"fast", 0.1, 0.05, 1e-3, 1e-3},
                    Motion{"jumps", 0.3, 0.3, 0.0, 0.0}, Motion{"falling", 3e-3, 1e-3, 0.0, 1e-4, 0.3},
                    Motion{"approach", 0.0, 0.0, 0.0, 0.0, 0.0, 0.011}),
    [](const auto& each) { return each.param.what; });

TEST_P(ContactSearches, FindTheContactsOfTheDefinition) {
  ModelSettings settings =
      test::contact_scene({cube_of(4, {0, 0, 0}), test::turned(cube_of(3, {0, 1.16, 0}), {0, 1, 0}, 20.0),
                           test::box_of({2, 9, 2}, {1.0, 0, 0.1})});
  ClothSettings& cloth = settings.cloths.emplace_back();
  cloth.particles = {6, 6};
  cloth.size = {2.0, 2.0};
  cloth.position = {0.0, -0.72, 0.0};
  cloth.rotation = {{1.0, 0.0, 0.0}, 90.0};
  settings.contact.self = true;
  const Model model = test::build(settings);
  ContactSearch<float> kept(model);
  Definition definition(model);
  Mover mover(model, 7);
  std::mt19937 random(11);
  Field<float> x = field<float>(model.initial_position.list(0, model.particle_count()));
  Field<float> v = x;
  if (GetParam().approach > 0.0) mover.part(x, 0.5 * spacing);
  std::size_t found = 0;
  for (std::uint64_t step = 0; step < 60; ++step) {
    if (step % 12 == 0) mover.turn_round(GetParam());
    const Field<float> start = x;
    for (Eigen::Index i = 0; i < v.cols(); ++i) v.col(i) = random_vector(random, 1.0);
    const Definition::Particles begin = {components(start.data()), components(std::as_const(v).data()), 3};
    kept.begin_step(step, begin);
    definition.begin_step(step, begin);
    // Where the step begins, in a stage on its way, and back.
    if (GetParam().approach > 0.0)
      mover.part(x, -GetParam().approach * spacing);
    else
      mover.move(x, GetParam());
    for (const Field<float>& place : {start, x, start}) {
      const std::vector<std::uint32_t> expected = bits(definition, place, v);
      ASSERT_EQ(bits(kept, place, v), expected) << "step " << step;
      found += expected.size();
    }
  }
  EXPECT_GT(found, 2000u);
}

}  // namespace
}  // namespace aspic::collision::moving
