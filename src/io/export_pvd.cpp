#include "io/export_pvd.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>

#include "base/printable.h"
#include "base/stopwatch.h"
#include "io/motion_sink.h"
#include "io/numbered_files.h"
#include "io/state_vtp.h"
#include "model/model.h"

namespace aspic {
namespace {

/// A collection of many files is long to write: between two there is this time [s].
constexpr double between_collections = 1.0;

std::string escaped(const std::string& text) {
  std::string xml;
  for (const char c : text) {
    const bool special = c == '&' || c == '<' || c == '>' || c == '"' || static_cast<unsigned char>(c) < 0x20;
    xml += special ? fmt::format("&#{};", static_cast<int>(c)) : std::string(1, c);
  }
  return xml;
}

/// Error (usage): the file's name has characters that no XML can hold.
Status check_name(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename();
  for (std::string_view rest = name; !rest.empty();) {
    const Utf8Character c = first_character(rest);
    if (!c.valid || (c.code < 0x20 && c.code != '\t' && c.code != '\n' && c.code != '\r'))
      return fail(ErrorCode::usage,
                  "{}: a .pvd file stores the names of its files as XML, which allows only UTF-8 without "
                  "control characters; choose another name.",
                  printable_line(path));
    rest.remove_prefix(c.size);
  }
  return {};
}

class PvdSeries final : public MotionSink {
 public:
  PvdSeries(const std::string& path, std::uint64_t every, Overwrite overwrite, AtomicFile file)
      : MotionSink(path, every),
        pattern_(with_ending(path, ".vtp")),
        overwrite_(overwrite),
        file_(std::move(file)) {}

 private:
  Status add(const Sample& sample) override {
    const std::uint64_t step = sample.state.step;
    if (samples() == 0 && overwrite_ == Overwrite::refuse) ASPIC_CHECK(refuse_later_files(pattern_, step));
    const std::string name = numbered(pattern_, step);
    ASPIC_TRY(auto file, AtomicFile::create(name, overwrite_));
    ASPIC_CHECK(write_state_vtp(file, sample));
    ASPIC_CHECK(file.commit());
    entries_ += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n",
                            static_cast<double>(step) * sample.model.simulation.timestep,
                            escaped(std::filesystem::path(name).filename().string()));
    if (written_ && seconds_since(*written_) < between_collections) return {};
    return write_collection();
  }
  Status complete(const Sample& last) override {
    std::string json(last.warnings);  // in a comment, which has no two hyphens in a row
    for (std::size_t at = 0; (at = json.find("--", at)) != json.npos;) json.replace(at, 2, "-\\u002d");
    if (!json.empty()) entries_ += "<!-- warnings: " + json + " -->\n";
    return write_collection();
  }

  Status write_collection() {
    // What is there since the first time is our own.
    if (!file_) {
      ASPIC_TRY(file_, AtomicFile::create(path(), written_ ? Overwrite::allow : overwrite_));
    }
    AtomicFile file = std::move(*file_);
    file_.reset();
    ASPIC_CHECK(file.write(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
        "<Collection>\n"));
    ASPIC_CHECK(file.write(entries_ + "</Collection>\n</VTKFile>\n"));
    ASPIC_CHECK(file.commit());
    written_ = std::chrono::steady_clock::now();
    return {};
  }

  std::string pattern_;  // of the samples' names
  Overwrite overwrite_;
  std::optional<AtomicFile> file_;
  std::string entries_;
  std::optional<std::chrono::steady_clock::time_point> written_;
};

}  // namespace

Result<std::unique_ptr<StateSink>> open_pvd(const std::string& path, std::uint64_t every, Overwrite overwrite,
                                            const RunFacts&) {
  ASPIC_CHECK(check_export_name(path));
  ASPIC_CHECK(check_name(path));
  ASPIC_TRY(auto file, AtomicFile::create(path, overwrite));
  return std::unique_ptr<StateSink>(std::make_unique<PvdSeries>(path, every, overwrite, std::move(file)));
}

}  // namespace aspic
