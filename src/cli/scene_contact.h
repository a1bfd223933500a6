#pragma once
// What `aspic scene check` says of contact between bodies.
#include <string>
#include <vector>

#include "analysis/contact_facts.h"
#include "aspic/scene.h"
#include "cli/json.h"

namespace aspic::cli {

/// The largest stable steps while bodies touch, by explicit method: where flat faces meet, and where edges
/// lie on each other. Empty: no bodies can touch.
struct ContactLimits {
  std::vector<StabilityLimit> faces, edges;
};

/// Lines, none of a model whose bodies cannot touch.
std::string contact_text(const Scene& scene, const Model& model, const ContactFacts& facts);
/// null of such a model.
Json contact_json(const Scene& scene, const Model& model, const ContactFacts& facts,
                  const ContactLimits& limits);
/// What to warn of, a sentence each.
std::vector<std::string> contact_warnings(const Model& model, const ContactFacts& facts,
                                          const ContactLimits& limits);

}  // namespace aspic::cli
