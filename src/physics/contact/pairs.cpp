#include "physics/contact/pairs.h"

namespace aspic::physics {
namespace {

template <class T>
PairConstants<T> rounded_pair(const ContactSettings& contact, const ContactBody& a, const ContactBody& b,
                              bool same, double ahead_step) {
  const ContactPair exact = contact_pair(contact, a, b, same);
  const ContactPair pair = ahead_step > 0.0 ? with_implicit_range(exact, ahead_step) : exact;
  return {static_cast<T>(pair.stiffness),
          static_cast<T>(pair.damping),
          static_cast<T>(pair.friction),
          static_cast<T>(pair.spacing),
          static_cast<T>(pair.reach),
          static_cast<T>(pair.range),
          static_cast<T>(pair.depth),
          static_cast<T>(pair.eased_depth),
          static_cast<T>(pair.margin),
          static_cast<T>(2e-6 * pair.spacing),
          b.closed,
          a.closed && b.closed};
}

}  // namespace

template <class T>
PairTable<T>::PairTable(const ContactSettings& contact, const std::vector<ContactBody>& bodies,
                        double ahead_step) {
  std::vector<const ContactBody*> kinds;
  for (const ContactBody& body : bodies) {
    const auto found = std::ranges::find_if(kinds, [&](const ContactBody* k) { return k->alike(body); });
    kind_.push_back(static_cast<std::uint32_t>(found - kinds.begin()));
    if (found == kinds.end()) kinds.push_back(&body);
  }
  kinds_ = static_cast<std::uint32_t>(kinds.size());
  for (const ContactBody* a : kinds) pairs_.push_back(rounded_pair<T>(contact, *a, *a, true, ahead_step));
  for (const ContactBody* a : kinds)
    for (const ContactBody* b : kinds) pairs_.push_back(rounded_pair<T>(contact, *a, *b, false, ahead_step));
}

template class PairTable<float>;
template class PairTable<double>;

}  // namespace aspic::physics
