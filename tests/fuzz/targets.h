#pragma once
// What the fuzzers throw bytes at: each reader of foreign bytes as a function that must take anything. The
// same functions run under libFuzzer (fuzz_main.cpp) and over the kept inputs in every build
// (replay_test.cpp).
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace aspic::fuzz {

/// One reader under attack.
struct Target {
  std::string_view name;                ///< also the directory of its corpus and of its regressions
  void (*run)(std::string_view bytes);  ///< throws std::logic_error where a promise is broken
  std::vector<std::string> (*seeds)();  ///< good inputs to begin with, made from the built-in files
  std::vector<std::string> (*words)();  ///< what its inputs are made of, for libFuzzer's dictionary
};

/// All targets, in the order in which they are run.
std::span<const Target> targets();
/// The target of a name, or nullptr.
const Target* find_target(std::string_view name);

/// Throws std::logic_error with the sentence unless `kept`.
void require(bool kept, std::string_view promise);

/// An error for people: one of these codes, a text that is not empty, nothing in it that moves a terminal.
void require_message(const Error& error, std::initializer_list<ErrorCode> codes);

// The targets. Each says in its own file what it demands of an accepted input.

/// A scene file.
extern const Target scene_target;
/// Arguments of --set, one a line, on the built-in scene that the first byte chooses.
extern const Target set_target;
/// Arguments of --view, in the same way.
extern const Target view_target;
/// A checkpoint: the bytes as they are, and once more with checksum and state hash made right.
extern const Target checkpoint_target;
/// An input log.
extern const Target inputs_target;
/// Configuration.txt.
extern const Target configuration_target;
/// A state table, in both precisions.
extern const Target state_csv_target;
/// The window's kept state.
extern const Target kept_state_target;
/// An array of numpy.
extern const Target npy_target;
/// Shader files with includes (parts separated by a zero byte), and a driver's compile log.
extern const Target shader_target;
/// Meshes of each format: read, repaired, made into cells with a skin.
extern const Target mesh_obj_target;
extern const Target mesh_stl_target;
extern const Target mesh_ply_target;

/// The words of scene files: keys, tables, words of enumerations, numbers at the ends of ranges.
std::vector<std::string> scene_words();

}  // namespace aspic::fuzz
