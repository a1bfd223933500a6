#pragma once
// Where the states of a run go, and the table of the formats they take.
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/files.h"
#include "aspic/inputs.h"
#include "io/atomic_file.h"

namespace aspic {

/// Those that hold for the sample's state.
inline const Inputs& inputs_of(const Sample& sample) {
  static const Inputs none;
  return sample.inputs != nullptr ? *sample.inputs : none;
}

/// Takes states of a run in the order of their steps. One that is destroyed before finish() leaves nothing
/// that looks complete, except the files of earlier steps.
class StateSink {
 public:
  StateSink(std::string path, std::uint64_t every) : path_(std::move(path)), every_(every) {}
  virtual ~StateSink() = default;

  /// Takes the first state of a run and those of next_step(). Errors: io; diverged if a number is not finite.
  virtual Status take(const Sample& sample) = 0;
  /// Takes the last state, which take() may have seen already, and completes the output. Errors as take().
  virtual Status finish(const Sample& last) = 0;
  /// The work of actuators up to the last state that it took [J], where it adds that up.
  virtual std::optional<double> actuator_work() const { return std::nullopt; }

  /// As the user gave it; with a * in place of the step where it is one of many files.
  const std::string& path() const { return path_; }
  /// Steps between the states it wants; 0: the last one alone.
  std::uint64_t every() const { return every_; }
  /// The first step after `step` whose state it wants besides the last one: the next multiple of every(); the
  /// largest number if there is none.
  virtual std::uint64_t next_step(std::uint64_t step) const {
    return every_ > 0 ? step + (every_ - step % every_) : std::numeric_limits<std::uint64_t>::max();
  }

 private:
  std::string path_;
  std::uint64_t every_;
};

/// A format of states.
struct StateFormat {
  std::string_view option;          ///< the kind of output: "state", also its option's name
  std::string_view ending;          ///< ".csv": of several formats of a kind, the file's name says which
  std::string_view label;           ///< for people: "CSV"
  std::string_view summary;         ///< what the option does, the same for all formats of a kind
  std::string_view every;           ///< what its interval does
  std::uint64_t default_every = 0;  ///< steps
  bool over_time = false;           ///< one file with rows of measures for many steps
  bool holds_scene = false;         ///< it is of use only if the scene says all of the run
  /// Opens the output, which proves that its place can be written. Errors (io): AtomicFile::create.
  Result<std::unique_ptr<StateSink>> (*open)(const std::string& path, std::uint64_t every,
                                             Overwrite overwrite, const RunFacts& facts) = nullptr;
  bool motion = false;              ///< states over time: only a run gives them
  std::string_view companion = {};  ///< what further files end in, in place of `ending`; * for the step
};

/// All formats; those of one option follow one another, its default first.
std::span<const StateFormat> state_formats();
/// The options of the table, each once, in its order.
std::vector<std::string_view> state_options();
/// What an option does and which formats it has: "write the final state as CSV (.csv)".
std::string state_help(std::string_view option);
/// Whether a file's name can be one of an option's outputs: it ends as one of its formats does, in letters of
/// either case, or in nothing, which means the first; devices and pipes have any name. Error (usage).
Status check_state_name(std::string_view option, const std::string& path);
/// The format of an option, which exists, that a file name's ending asks for; the option's default where no
/// ending fits.
const StateFormat& state_format_of(std::string_view option, std::string_view path);

}  // namespace aspic
