// The cost of frames: `aspic bench --images`.
#include <fmt/format.h>

#include "cli/bench.h"
#include "cli/frame_cost.h"
#include "io/console.h"

namespace aspic::cli {
namespace {

Json json_of_cost(const BenchOptions& options, const Scene& scene, const FrameCost& cost) {
  Json passes = Json::array();
  for (const gl::PassTime& pass : cost.passes)
    passes.push_back({{"name", pass.name},
                      {"milliseconds", pass.milliseconds},
                      {"processor_milliseconds", pass.processor_milliseconds}});
  Json json = origin_json();
  json.update({{"scene", scene.name},
               {"renderer", cost.device},
               {"width", options.images->width},
               {"height", options.images->height},
               {"images", cost.seconds.size()},
               {"median_seconds", quantile_of(cost.seconds, 0.5)},
               {"median_processor_seconds", quantile_of(cost.cpu_seconds, 0.5)},
               {"fastest_seconds", quantile_of(cost.seconds, 0.0)},
               {"slowest_seconds", quantile_of(cost.seconds, 1.0)},
               {"seconds", cost.seconds},
               {"processor_seconds", cost.cpu_seconds},
               {"passes", passes}});
  return json;
}

std::string table_of_cost(const BenchOptions& options, const Scene& scene, const FrameCost& cost) {
  std::string text = fmt::format(
      "{}, images of {} x {} on {}\n{:.2f} ms per image, {:.2f} ms of CPU time; medians of {}, {:.2f} to "
      "{:.2f} ms\n\n{:<24} {:>10} {:>14}\n",
      scene.name, options.images->width, options.images->height, cost.device,
      1e3 * quantile_of(cost.seconds, 0.5), 1e3 * quantile_of(cost.cpu_seconds, 0.5), cost.seconds.size(),
      1e3 * quantile_of(cost.seconds, 0.0), 1e3 * quantile_of(cost.seconds, 1.0), "pass by pass", "ms",
      "CPU ms");
  double sum = 0.0, processor_sum = 0.0;
  for (const gl::PassTime& pass : cost.passes) {
    text += fmt::format("{:<24} {:>10.3f} {:>14.3f}\n", pass.name, pass.milliseconds,
                        pass.processor_milliseconds);
    sum += pass.milliseconds;
    processor_sum += pass.processor_milliseconds;
  }
  text += fmt::format("{:<24} {:>10.3f} {:>14.3f}\n", "all", sum, processor_sum);
  return text;
}

}  // namespace

Status execute_images(const BenchOptions& options, const Scene& scene, const InterruptGuard& interrupt) {
  FrameCostOptions measured;
  measured.size = *options.images;
  measured.duration = options.duration.value_or(measured.duration);
  measured.repeats = options.repeats;
  measured.warm_up = options.warm_up;
  ASPIC_TRY(const auto cost, measure_frames(scene, options.backends.front(), measured,
                                            [&] { return interrupt.interrupted(); }));
  return options.json ? print_data(to_text(json_of_cost(options, scene, cost)))
                      : print_text(table_of_cost(options, scene, cost));
}

}  // namespace aspic::cli
