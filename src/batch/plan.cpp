#include "batch/plan.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <unordered_map>
#include <utility>

#include "base/result.h"
#include "cpu_parallel/stack.h"
#include "model/springs.h"

namespace aspic::batch {
namespace {

using parallel::stack_lanes;

/// Springs of a model that helpers may share: fewer pay for no second thread.
constexpr std::uint64_t springs_for_helpers = 16384;

/// Instances that may share stacks.
struct Group {
  SharedModel first;
  std::vector<std::size_t> instances;
};

std::vector<Group> groups_of(const std::vector<SharedModel>& models) {
  std::vector<Group> groups;
  std::unordered_map<const Model*, std::size_t> known;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto [at, added] = known.try_emplace(models[i].get(), groups.size());
    if (added) {
      const auto same = [&](const Group& group) {
        return parallel::Stack::takes(*models[i]) && parallel::Stack::takes(*group.first) &&
               parallel::Stack::same(*group.first, *models[i]);
      };
      at->second = static_cast<std::size_t>(std::ranges::find_if(groups, same) - groups.begin());
      if (at->second == groups.size()) groups.push_back({models[i], {}});
    }
    groups[at->second].instances.push_back(i);
  }
  return groups;
}

std::size_t rounded_up(std::size_t n, std::size_t by) {
  return (n + by - 1) / by;
}

/// Whether `count` instances end sooner in stacks.
bool stacks_pay(const Model& model, std::size_t count, unsigned threads) {
  if (!parallel::Stack::takes(model)) return false;
  const std::size_t stacks = rounded_up(count, stack_lanes);
  return static_cast<double>(rounded_up(stacks, threads)) * cost_of_stack(model) <
         static_cast<double>(rounded_up(count, threads));
}

/// A unit to be made.
struct Draft {
  std::vector<std::size_t> instances;
  double cost = 0.0;
  std::shared_ptr<const parallel::UpperEnds> springs;  ///< null: a model alone
};

}  // namespace

Result<Plan> make_units(const std::vector<SharedModel>& models, unsigned threads) {
  Plan plan;
  std::vector<Draft> drafts;
  double all = 0.0;
  for (const Group& group : groups_of(models)) {
    const std::size_t count = group.instances.size(), stacks = rounded_up(count, stack_lanes);
    const double cost = cost_of(*group.first);
    const auto from = group.instances.begin();
    if (stacks_pay(*group.first, count, threads)) {
      const double of_stack = cost * cost_of_stack(*group.first);
      const auto springs = std::make_shared<const parallel::UpperEnds>(*group.first);
      plan.shared_bytes += springs->bytes();
      for (std::size_t n = 0; n < stacks; ++n)
        drafts.push_back({{from + static_cast<std::ptrdiff_t>(count * n / stacks),
                           from + static_cast<std::ptrdiff_t>(count * (n + 1) / stacks)},
                          of_stack,
                          springs});
      all += of_stack * static_cast<double>(stacks);
    } else {
      for (const std::size_t i : group.instances) drafts.push_back({{i}, cost, nullptr});
      all += cost * static_cast<double>(count);
    }
  }
  std::ranges::stable_sort(drafts, std::ranges::greater(), &Draft::cost);
  plan.places.resize(models.size());
  for (const Draft& draft : drafts) {
    for (std::size_t slot = 0; slot < draft.instances.size(); ++slot)
      plan.places[draft.instances[slot]] = {plan.units.size(), slot};
    if (draft.springs) {
      std::vector<SharedModel> members;
      for (const std::size_t i : draft.instances) members.push_back(models[i]);
      plan.units.push_back(make_stack(members, draft.springs));
      continue;
    }
    const SharedModel& model = models[draft.instances.front()];
    // Cutting a model into pieces costs a little, so only those are cut that others may have to wait for.
    const bool helped =
        threads > 1 && draft.cost > all / (4.0 * threads) && spring_count(*model) >= springs_for_helpers;
    ASPIC_TRY(auto unit, make_lone(model, helped ? parallel::Workers::of_helpers(threads) : nullptr));
    plan.units.push_back(std::move(unit));
  }
  return plan;
}

Status for_each_unit(parallel::Workers& pool, const std::vector<std::unique_ptr<Unit>>& units,
                     const std::function<Status(std::size_t)>& act) {
  std::vector<Status> ends(units.size());
  std::atomic<std::size_t> next = 0;
  for (const auto& unit : units)
    if (parallel::Workers* const helpers = unit->helped()) helpers->admit();
  // A piece is what a thread does from beginning to end; who comes later finds nothing left.
  pool.run(pool.threads(), [&](std::size_t) {
    for (std::size_t n = next++; n < units.size(); n = next++) {
      ends[n] = act(n);
      if (parallel::Workers* const helpers = units[n]->helped()) helpers->release();
    }
    for (const auto& unit : units)
      if (parallel::Workers* const helpers = unit->helped()) helpers->help();
  });
  for (Status& end : ends)
    if (!end) return std::move(end);
  return {};
}

}  // namespace aspic::batch
