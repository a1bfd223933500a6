#pragma once
// The figures of a run as its row has them.
#include <vector>

#include "analysis/course.h"
#include "aspic/sweep.h"

namespace aspic {

/// Simulated time between the samples that figures of a course are taken from [s].
inline constexpr double sample_interval = 1.0 / 60.0;

/// In the order of columns.
std::vector<RunFigure> figures_of(const CourseSummary& summary);

}  // namespace aspic
