#pragma once
// The ground inside the equation of implicit Euler (Coulomb model), v' = P(v + h·w·f(x + h·v', v')), for one
// particle. P leaves a velocity as it is unless the step would end below a surface; then it stops the
// particle there, within the friction cone. The motion left to it is the space in which the linear
// system is solved (docs/physics.md). Every expression has one order of operations, which the kernels follow
// (shaders/compute/terms/implicit_ground.glsl).
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "model/implicit.h"
#include "physics/terrain/coulomb.h"

namespace aspic::physics {

/// Directions that the ground leaves free: all, the tangent plane of one terrain, the line along two, or
/// nothing.
enum class Freedom { all, plane, line, none };

/// P at one velocity, and the part of its derivative that the linear system takes.
template <class T>
struct GroundReaction {
  Vector<T> v = Vector<T>::Zero();  ///< P(v) [m/s]
  Freedom freedom = Freedom::all;
  Vector<T> axis = Vector<T>::Zero();    ///< plane: its normal; line: its direction; unit vectors
  Vector<T> across = Vector<T>::Zero();  ///< plane: unit vector in it across the slip; zero without slip
  T stiffness = T(0);                    ///< m·(1/turn − 1) across the slip [kg]
  std::array<std::size_t, 3> held{};     ///< indices of the terrains that hold the particle
  std::size_t count = 0;                 ///< so many of them

  GroundReaction() = default;
  /// No reaction: P(v) = v.
  explicit GroundReaction(const Vector<T>& free) : v(free) {}

  /// The part of y that the ground leaves free.
  Vector<T> free_part(const Vector<T>& y) const {
    if (freedom == Freedom::all) return y;
    if (freedom == Freedom::plane) return y - dot3<T>(y, axis) * axis;
    if (freedom == Freedom::line) return dot3<T>(y, axis) * axis;
    return Vector<T>::Zero();
  }

  /// The rest of it, of a particle that is held.
  Vector<T> held_part(const Vector<T>& y) const {
    if (freedom == Freedom::plane) return dot3<T>(y, axis) * axis;
    if (freedom == Freedom::line) return y - dot3<T>(y, axis) * axis;
    return y;
  }

  /// Right-hand side of the linear system for a held particle of mass m and residual R, before the prescribed
  /// part of the solution is taken to this side.
  Vector<T> right_hand_side(T m, const Vector<T>& R) const {
    if (freedom == Freedom::none) return Vector<T>::Zero();
    const Vector<T> r = -(m * free_part(R));
    return freedom == Freedom::plane ? Vector<T>(r - turning(R)) : r;
  }

  /// Friction's part of the matrix times p: it turns with the slip, so it resists whatever turns that.
  Vector<T> turning(const Vector<T>& p) const { return (stiffness * dot3<T>(across, p)) * across; }

  /// What the ground leaves free of the matrix times p, given the springs' part of the product.
  Vector<T> free_product(const Vector<T>& p, const Vector<T>& product) const {
    return free_part(freedom == Freedom::plane ? Vector<T>(product + turning(p)) : product);
  }

  bool holds(std::size_t terrain) const {
    for (std::size_t k = 0; k < count; ++k) {
      if (held[k] == terrain) return true;
    }
    return false;
  }
};

/// Share of a slip [m/s] that friction leaves when it may take up to `loss` [m/s] off it; 0 holds the
/// particle.
template <class T>
T slip_kept(T slip, T loss) {
  if (slip > T(0)) return T(1) - loss / slip;
  return loss > T(0) ? T(0) : T(1);
}

/// P of every particle in one step.
template <class T>
class GroundAhead {
 public:
  /// `grounds` must outlive this. Nothing reacts unless `acts`.
  GroundAhead(const std::vector<Ground<T>>& grounds, const ContactConstants<T>& contact, bool acts)
      : grounds_(&grounds),
        h_(contact.step),
        same_surface_(static_cast<T>(same_surface_share) * contact.distance),
        acts_(acts && !grounds.empty()) {}

  bool acts() const { return acts_; }

  /// A step begins with the particles at x.
  void start(const Field<T>& x) {
    gaps_.clear();
    if (!acts_) return;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      for (const Ground<T>& ground : *grounds_) gaps_.push_back(gap<T>(ground, ground.start, x.col(i)));
    }
  }

  /// P of particle i, of mass m, with free velocity v [m/s]. Terrains take their turns in file order. One
  /// that the velocity left so far would cross joins the fewest of those that hold the particle already with
  /// which none is crossed and none pulls: without friction, the nearest velocity that crosses none. A second
  /// round checks whether a later terrain has moved the particle through an earlier one. Of terrains that
  /// are one surface to the particle, the one that outranks the others holds it.
  GroundReaction<T> react(Eigen::Index i, T m, const Vector<T>& v) const {
    return react_to(&gaps_[static_cast<std::size_t>(i) * grounds_->size()], m, v);
  }

  /// The same of a particle with the `gaps` to every terrain at the step's start.
  GroundReaction<T> react_to(const Gap<T>* gaps, T m, const Vector<T>& v) const {
    GroundReaction<T> reaction(v);
    for (int round = 0; round < 2; ++round) {
      for (std::size_t t = 0; t < grounds_->size(); ++t) {
        if (reaction.holds(t)) continue;
        const std::size_t twin = twin_of(gaps, t, reaction);
        const bool joins = twin == none ? crosses(gaps, t, reaction) : outranks(t, twin);
        if (joins) reaction = joined(gaps, m, v, reaction, t, twin);
      }
      if (reaction.count == 0 || grounds_->size() == 1) break;
    }
    return reaction;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  /// Normal speed [m/s] that brings a particle to the surface by the step's end, c, against still ground.
  T least_speed(const Gap<T>& at) const { return -((at.d > T(0) ? at.d : T(0)) / h_); }

  /// The same against terrain t, which may move.
  T least_speed(const Gap<T>* gaps, std::size_t t) const {
    const GroundPose<T>& pose = (*grounds_)[t].end;
    const T c = least_speed(gaps[t]);
    return pose.moves ? c + dot3<T>(pose.velocity, gaps[t].n) : c;
  }

  /// The speed along an axis from which slip on two terrains is counted: the mean of theirs, weighted by the
  /// slip that the friction of each can take.
  T speed_along(const Vector<T>& axis, std::size_t a, std::size_t b, T loss_a, T loss_b) const {
    const auto speed = [&](std::size_t t) {
      const GroundPose<T>& pose = (*grounds_)[t].end;
      return pose.moves ? dot3<T>(pose.velocity, axis) : T(0);
    };
    const T loss = loss_a + loss_b;
    return loss > T(0) ? (loss_a * speed(a) + loss_b * speed(b)) / loss : T(0);
  }

  bool crosses(const Gap<T>* gaps, std::size_t t, const GroundReaction<T>& reaction) const {
    return !reaction.holds(t) && dot3<T>(reaction.v, gaps[t].n) < least_speed(gaps, t);
  }

  /// The terrain among those that hold the particle which is one surface with terrain t, or none: they face
  /// the same way, and rounding may decide which of them the particle crosses.
  std::size_t twin_of(const Gap<T>* gaps, std::size_t t, const GroundReaction<T>& reaction) const {
    for (std::size_t k = 0; k < reaction.count; ++k) {
      const std::size_t s = reaction.held[k];
      const Vector<T> line = cross3<T>(gaps[t].n, gaps[s].n);
      if (dot3<T>(line, line) > static_cast<T>(least_wedge)) continue;
      if (!(dot3<T>(gaps[t].n, gaps[s].n) > T(0))) continue;
      const T apart = h_ * std::abs(least_speed(gaps, t) - least_speed(gaps, s));
      if (apart <= same_surface_) return s;
    }
    return none;
  }

  /// Which of two terrains that are one surface holds a particle: the one with more friction, then the lower
  /// index.
  bool outranks(std::size_t t, std::size_t s) const {
    return (*grounds_)[t].friction > (*grounds_)[s].friction ||
           ((*grounds_)[t].friction == (*grounds_)[s].friction && t < s);
  }

  /// Terrain t joins those that hold the particle so far, and takes the place of `twin` among them.
  GroundReaction<T> joined(const Gap<T>* gaps, T m, const Vector<T>& v, const GroundReaction<T>& so_far,
                           std::size_t t, std::size_t twin) const {
    std::array<std::size_t, 3> others{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < so_far.count; ++k) {
      if (so_far.held[k] != twin) others[count++] = so_far.held[k];
    }
    if (count == 3) return so_far;
    const std::size_t subsets = std::size_t{1} << count;
    for (std::size_t subset = 0; subset < subsets; ++subset) {
      GroundReaction<T> next(v);
      for (std::size_t k = 0; k < count; ++k) {
        if ((subset >> k) & 1) next.held[next.count++] = others[k];
      }
      next.held[next.count++] = t;
      const bool possible = next.count == 1   ? on_one(gaps, m, v, next)
                            : next.count == 2 ? between_two(gaps, v, subset + 1 == subsets, next)
                                              : among_three(gaps, next);
      if (!possible) continue;
      bool crossing = false;
      for (std::size_t k = 0; k < count; ++k) crossing = crossing || crosses(gaps, others[k], next);
      if (!crossing) return next;
    }
    return so_far;
  }

  /// Coulomb's law on one surface: P(v) = keep·v_t + c·n.
  bool on_one(const Gap<T>* gaps, T m, const Vector<T>& v, GroundReaction<T>& out) const {
    const Gap<T>& at = gaps[out.held[0]];
    const GroundPose<T>& pose = (*grounds_)[out.held[0]].end;
    const Vector<T> v_r = pose.relative(v);
    const T u = dot3<T>(v_r, at.n), c = least_speed(at);
    const Vector<T> v_t = v_r - u * at.n;
    const T slip = norm3<T>(v_t), keep = slip_kept<T>(slip, (*grounds_)[out.held[0]].friction * (c - u));
    out.v = c * at.n;
    out.freedom = Freedom::none;
    if (keep > T(0)) {
      const T turn = keep > static_cast<T>(least_turn) ? keep : static_cast<T>(least_turn);
      out.v = keep * v_t + out.v;
      out.freedom = Freedom::plane;
      out.axis = at.n;
      out.stiffness = m * (T(1) / turn - T(1));
      if (slip > T(0)) out.across = (T(1) / slip) * cross3<T>(at.n, v_t);
    }
    out.v = pose.absolute(out.v);
    return u < c;
  }

  /// Two surfaces leave the line along both; both normal impulses bear on the friction there. The last choice
  /// is taken even if one would have to pull, which only friction can ask for; it does not.
  bool between_two(const Gap<T>* gaps, const Vector<T>& v, bool last, GroundReaction<T>& out) const {
    const Gap<T>&a = gaps[out.held[0]], &b = gaps[out.held[1]];
    const Vector<T> line = cross3<T>(a.n, b.n);
    const T sine2 = dot3<T>(line, line), cosine = dot3<T>(a.n, b.n);
    if (!(sine2 > static_cast<T>(least_wedge))) return false;
    const std::size_t i = out.held[0], j = out.held[1];
    const T c_a = least_speed(gaps, i), c_b = least_speed(gaps, j);
    const T short_a = c_a - dot3<T>(v, a.n), short_b = c_b - dot3<T>(v, b.n);
    const T normal_a = (short_a - cosine * short_b) / sine2, normal_b = (short_b - cosine * short_a) / sine2;
    if (!last && (normal_a < T(0) || normal_b < T(0))) return false;
    const T loss_a = (*grounds_)[i].friction * (normal_a > T(0) ? normal_a : T(0));
    const T loss_b = (*grounds_)[j].friction * (normal_b > T(0) ? normal_b : T(0));
    out.axis = (T(1) / std::sqrt(sine2)) * line;
    const bool moves = (*grounds_)[i].end.moves || (*grounds_)[j].end.moves;
    const T still = moves ? speed_along(out.axis, i, j, loss_a, loss_b) : T(0);
    const T speed = dot3<T>(v, out.axis), slip = moves ? speed - still : speed;
    const T keep = slip_kept<T>(std::abs(slip), loss_a + loss_b);
    out.v = ((c_a - cosine * c_b) / sine2) * a.n + ((c_b - cosine * c_a) / sine2) * b.n;
    out.freedom = Freedom::none;
    if (keep > T(0)) {
      out.v = (keep * slip) * out.axis + out.v;
      out.freedom = Freedom::line;
    }
    if (moves) out.v = still * out.axis + out.v;
    return true;
  }

  /// Three surfaces leave one point.
  bool among_three(const Gap<T>* gaps, GroundReaction<T>& out) const {
    const Gap<T>&a = gaps[out.held[0]], &b = gaps[out.held[1]], &c = gaps[out.held[2]];
    const Vector<T> bc = cross3<T>(b.n, c.n), ca = cross3<T>(c.n, a.n), ab = cross3<T>(a.n, b.n);
    const T volume = dot3<T>(a.n, bc);
    if (!(volume * volume > static_cast<T>(least_wedge))) return false;
    const Vector<T> sum = (least_speed(gaps, out.held[0]) * bc + least_speed(gaps, out.held[1]) * ca) +
                          least_speed(gaps, out.held[2]) * ab;
    out.v = (T(1) / volume) * sum;
    out.freedom = Freedom::none;
    return true;
  }

  const std::vector<Ground<T>>* grounds_;
  std::vector<Gap<T>> gaps_;  ///< at the step's start, every terrain of every particle
  T h_;
  T same_surface_;  ///< distance [m] up to which parallel surfaces are one
  bool acts_;
};

/// The end of a solved step that began at x0, v0: a particle that came fast and that this ground held
/// bounces. The solve hides how it came, so the speed it met the surface with is that of free fall. None
/// stays below the surface.
template <class T>
void respond_solved(const Ground<T>& ground, const ContactConstants<T>& contact, const Vector<T>& gravity,
                    T m, bool held, const Vector<T>& x0, const Vector<T>& v0, Vector<T>& x, Vector<T>& v) {
  const Gap<T> g = gap<T>(ground, x);
  if (held) {
    const Gap<T> g0 = gap<T>(ground, ground.start, x0);
    const Vector<T> v_r = ground.end.relative(v);
    const T u0 = dot3<T>(ground.start.relative(v0), g0.n), u = dot3<T>(v_r, g.n);
    if (-u0 > contact.resting_speed) {
      const T du = contact.step * dot3<T>(gravity, g.n);
      const T mean = u0 + du, drop = -(contact.step * mean);
      const T u_after = bounced_speed<T>(ground, contact, m, g0.d, drop, u0, du, mean);
      if (u_after > u) {
        const Vector<T> v_t = v_r - u * g.n;
        v = ground.end.absolute(after_friction<T>(v_t, ground.friction * (u_after - u)) + u_after * g.n);
      }
    }
  }
  if (g.d < T(0)) x = x - g.d * g.n;
}

}  // namespace aspic::physics
