#pragma once
// Public headers of libaspic: scenes, models and their solvers, measures, files. Link
// aspic::aspic. No window and no command line is part of it. Fallible calls return a Result (base/result.h).

#include "base/result.h"  // Result, Status, Error

// model: the simulated bodies, as plain data in SI units
#include "model/model.h"   // Model, build_model()
#include "model/solver.h"  // Solver: load(), advance(), state(), set_pull()
#include "model/state.h"   // State, initial_state(), state_hash_text()

// scene: TOML and back
#include "scene/load.h"   // load_scene(), parse_scene(), list_builtin_scenes()
#include "scene/scene.h"  // Scene
#include "scene/write.h"  // to_toml()

// run: backends and recording
#include "run/backends.h"   // backends(), make_backend()
#include "run/recorder.h"   // films without a window
#include "run/run_files.h"  // output files of a run: states, series, checkpoints

// analysis: energies, comparison, stable steps
#include "analysis/compare.h"    // compare_states()
#include "analysis/energy.h"     // measure()
#include "analysis/stability.h"  // stability_limit()

// io: files
#include "io/checkpoint.h"  // read_checkpoint(), write_checkpoint()
#include "io/series_csv.h"  // SeriesWriter
#include "io/state_csv.h"   // write_state_csv()
#include "io/state_vtp.h"   // write_state_vtp()
