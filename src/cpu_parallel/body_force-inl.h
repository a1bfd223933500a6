// physics/body_force.h in lanes, for files that Highway compiles once for each instruction set.
#if defined(ASPIC_BODY_FORCE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASPIC_BODY_FORCE_INL_H
#undef ASPIC_BODY_FORCE_INL_H
#else
#define ASPIC_BODY_FORCE_INL_H
#endif

#include "cpu_parallel/lanes-inl.h"
#include "physics/body_force.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

struct BodyForce {
  Vector gravity;
  Float drag;

  /// The same in all lanes.
  HWY_INLINE explicit BodyForce(const physics::BodyForce<float>& of)
      : BodyForce(0, [&](const auto& constant) { return hn::Set(tag, constant(of)); }) {}
  /// That of each lane.
  HWY_INLINE explicit BodyForce(const physics::BodyForce<float>* of)
      : BodyForce(0, [&](const auto& constant) {
          alignas(64) float values[lanes];
          for (std::size_t lane = 0; lane < lanes; ++lane) values[lane] = constant(of[lane]);
          return hn::Load(tag, values);
        }) {}

  HWY_INLINE Vector at(Float m, const Vector& v) const { return m * gravity - hn::Mul(drag, m) * v; }
  HWY_INLINE Float implicit_mass(Float m, const Vector& /*v*/, Float h) const {
    return hn::Add(m, hn::Mul(h, hn::Mul(drag, m)));
  }

 private:
  using Of = const physics::BodyForce<float>&;
  template <class Each>
  HWY_INLINE BodyForce(int, const Each& each)
      : gravity{each([](Of f) { return f.gravity.x(); }), each([](Of f) { return f.gravity.y(); }),
                each([](Of f) { return f.gravity.z(); })},
        drag(each([](Of f) { return f.drag; })) {}
};

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
