#pragma once
// What hands did to a run, as aspic run --replay takes it.
#include "aspic/error.h"
#include "aspic/inputs.h"
#include "playback/history.h"

namespace aspic {

/// Pulls and pins of a run from its start to `until`, for the scene of the stretch that this is in. Error
/// (usage), with a sentence for people: what a log cannot hold happened on the way (balls were thrown, the
/// scene's physics changed), or the history does not reach back to the start any more.
Result<InputLog> recorded_inputs(const History& history, const Moment& until);

/// Those that hold at `now` and from its step on, for a checkpoint there: with the past where a log can hold
/// it, else alone, and with what the `later` steps of a log that the run replays have. Error (usage): balls
/// were thrown.
Result<InputLog> inputs_to_go_on(const History& history, const Moment& now, const InputLog& later);

}  // namespace aspic
