#include "physics/contact/pairs.h"

namespace aspic::physics {
namespace {

template <class T>
TouchConstants<T> rounded_pair(const ContactSettings& contact, const TouchBody& a, const TouchBody& b,
                               bool same, double ahead_step) {
  const TouchPair exact = touch_pair(contact, a, b, same);
  const TouchPair pair = ahead_step > 0.0 ? seen_ahead(exact, ahead_step) : exact;
  return {static_cast<T>(pair.stiffness),
          static_cast<T>(pair.damping),
          static_cast<T>(pair.friction),
          static_cast<T>(pair.spacing),
          static_cast<T>(pair.reach),
          static_cast<T>(pair.sight),
          static_cast<T>(pair.depth),
          static_cast<T>(pair.eased_depth),
          static_cast<T>(pair.margin),
          static_cast<T>(2e-6 * pair.spacing),
          b.closed,
          a.closed && b.closed};
}

}  // namespace

template <class T>
TouchTable<T>::TouchTable(const ContactSettings& contact, const std::vector<TouchBody>& bodies,
                          double ahead_step) {
  std::vector<const TouchBody*> kinds;
  for (const TouchBody& body : bodies) {
    const auto found = std::ranges::find_if(kinds, [&](const TouchBody* k) { return k->alike(body); });
    kind_.push_back(static_cast<std::uint32_t>(found - kinds.begin()));
    if (found == kinds.end()) kinds.push_back(&body);
  }
  kinds_ = static_cast<std::uint32_t>(kinds.size());
  for (const TouchBody* a : kinds) pairs_.push_back(rounded_pair<T>(contact, *a, *a, true, ahead_step));
  for (const TouchBody* a : kinds)
    for (const TouchBody* b : kinds) pairs_.push_back(rounded_pair<T>(contact, *a, *b, false, ahead_step));
}

template class TouchTable<float>;
template class TouchTable<double>;

}  // namespace aspic::physics
