#pragma once
// All of libaspic: scenes, models and their solvers, measures, files. Link aspic::aspic. No window and no
// command line is part of it. Fallible calls return a Result. Free functions may be called on any thread, and
// on several at once as long as none changes what another uses; classes say which threads theirs come from.
// Structs without such words are plain values: one thread changes them, or several read.

#include "aspic/analysis.h"    // measure(), compare_states(), stability_limit()
#include "aspic/batch.h"       // Batch: many models stepped together
#include "aspic/body_mesh.h"   // body_mesh(): what bodies of cells are drawn as
#include "aspic/error.h"       // Result, Status, Error, worded()
#include "aspic/files.h"       // write_state(), read_checkpoint(), write_checkpoint()
#include "aspic/inputs.h"      // Inputs: pulls, pins, channels; InputLog
#include "aspic/model.h"       // make_model(), initial_state(), masses, springs, surfaces
#include "aspic/parameters.h"  // list_parameters(), value_of(): the keys of scenes
#include "aspic/run.h"         // make_backend(), RunFiles, Recorder, StillPainter
#include "aspic/scene.h"       // Scene, load_scene(), parse_scene(), to_toml()
#include "aspic/settings.h"    // ModelSettings
#include "aspic/solver.h"      // Solver: load(), advance(), state(), set_inputs()
#include "aspic/state.h"       // State, state_fields, state_hash_text()
#include "aspic/state_view.h"  // StateView: numbers where they lie
#include "aspic/sweep.h"       // sweep_run(), RunFigures: runs with names, for parameter studies
#include "aspic/vec.h"         // Vec3
#include "aspic/version.h"     // ASPIC_VERSION, library_version()
