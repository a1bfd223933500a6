#include "variants/sweep_figures.h"

#include <cmath>
#include <utility>

#include "analysis/course.h"

namespace aspic {

struct RunFigures::Parts {
  SharedModel model;  // which the course refers to
  Course course;
};

RunFigures::RunFigures(SharedModel model) {
  const Model& described = *model;
  parts_ = std::make_unique<Parts>(Parts{std::move(model), Course(described)});
}
RunFigures::RunFigures(RunFigures&&) noexcept = default;
RunFigures& RunFigures::operator=(RunFigures&&) noexcept = default;
RunFigures::~RunFigures() = default;

std::uint64_t RunFigures::interval(double timestep) {
  return sample_stride(timestep, sample_interval);
}

void RunFigures::take(const State& state) {
  parts_->course.take(state);
}

std::vector<RunFigure> RunFigures::figures() const {
  return figures_of(parts_->course.summary());
}

std::vector<RunFigure> figures_of(const CourseSummary& summary) {
  const Measures& m = summary.end.measures;
  std::vector<RunFigure> figures = {{"time", summary.end.time},
                                    {"height", summary.end.height},
                                    {"lowest", summary.end.lowest},
                                    {"kinetic", m.kinetic},
                                    {"elastic", m.elastic},
                                    {"gravitational", m.gravitational},
                                    {"total", m.total()},
                                    {"max_speed", m.max_speed},
                                    {"contact_time", summary.contact_time},
                                    {"squash", summary.squash},
                                    {"squash_time", summary.squash_time},
                                    {"rest_time", summary.rest_time},
                                    {"slide", summary.end.slide}};
  for (RunFigure& figure : figures)
    if (figure.value && !std::isfinite(*figure.value)) figure.value.reset();
  return figures;
}

}  // namespace aspic
