#include "io/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include "base/files.h"
#include "base/fnv.h"
#include "base/memory.h"
#include "base/printable.h"
#include "io/state_csv.h"
#include "model/counts.h"
#include "model/model.h"

namespace aspic {
namespace {

constexpr std::string_view magic = checkpoint_mark;

/// The lowest `bytes` bytes of a value, little-endian.
void append(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i)
    out.push_back(static_cast<char>(static_cast<unsigned char>(value >> (8 * i))));
}

void append_text(std::string& out, std::string_view text) {
  append(out, text.size(), 8);
  out += text;
}

/// Three numbers, little-endian.
template <class T, class Bits>
void append_vector(std::string& out, const Vec3& v) {
  std::array<char, 3 * sizeof(T)> bytes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Bits bits = std::bit_cast<Bits>(static_cast<T>(v[static_cast<int>(axis)]));
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes[axis * sizeof(T) + i] = static_cast<char>(static_cast<unsigned char>(bits >> (8 * i)));
  }
  out.append(bytes.data(), bytes.size());
}

/// Reads little-endian values; past the end it gives zeros and remembers the failure.
class Decoder {
 public:
  explicit Decoder(std::string_view bytes) : rest_(bytes) {}

  std::uint64_t get(int bytes) {
    std::uint64_t value = 0;
    const std::string_view raw = take(static_cast<std::uint64_t>(bytes));
    for (std::size_t i = 0; i < raw.size(); ++i) {
      value |= std::uint64_t{static_cast<unsigned char>(raw[i])} << (8 * i);
    }
    return value;
  }
  std::string_view text() { return take(get(8)); }
  std::string_view take(std::uint64_t bytes) {
    if (bytes > rest_.size()) {
      failed_ = true;
      rest_ = {};
      return {};
    }
    const std::string_view taken = rest_.substr(0, bytes);
    rest_.remove_prefix(bytes);
    return taken;
  }
  std::size_t left() const { return rest_.size(); }
  bool failed() const { return failed_; }

 private:
  std::string_view rest_;
  bool failed_ = false;
};

std::uint64_t checksum(std::string_view bytes) {
  Fnv1a hash;
  hash.add_bytes(std::as_bytes(std::span(bytes)));
  return hash.value();
}

double get_number(Decoder& in, Precision precision) {
  if (precision == Precision::single) return std::bit_cast<float>(static_cast<std::uint32_t>(in.get(4)));
  return std::bit_cast<double>(in.get(8));
}

}  // namespace

std::string encode_checkpoint(const Checkpoint& checkpoint) {
  const State& state = checkpoint.state;
  std::string out(magic);
  append(out, checkpoint_version, 4);
  append(out, state.precision == Precision::single ? 4 : 8, 4);
  append(out, state.step, 8);
  append(out, std::bit_cast<std::uint64_t>(checkpoint.timestep), 8);
  append(out, state_hash(state), 8);
  append_text(out, checkpoint.program_version);
  append_text(out, checkpoint.scene);
  append_text(out, checkpoint.inputs);
  append(out, state_fields.size(), 4);
  for (const StateField& field : state_fields) {
    append_text(out, field.name);
    append(out, static_cast<std::uint64_t>(field.carrier), 4);
    append(out, StateField::components, 4);
  }
  append(out, state.position.size(), 8);
  append(out, state.ball_position.size(), 8);
  const bool single = state.precision == Precision::single;
  std::size_t numbers = 0;
  for (const StateCarrier carrier : {StateCarrier::particle, StateCarrier::ball})
    numbers += count_of(state, carrier) * numbers_of(carrier);
  out.reserve(out.size() + numbers * (single ? sizeof(float) : sizeof(double)) + 8);
  for_each_vector(state, [&](const Vec3& v) {
    single ? append_vector<float, std::uint32_t>(out, v) : append_vector<double, std::uint64_t>(out, v);
  });
  append(out, checksum(out), 8);
  return out;
}

namespace {

constexpr std::uint32_t first_with_inputs = 3, first_with_fields = 3;

bool is_read(std::uint32_t version) {
  return version >= oldest_checkpoint_version && version <= checkpoint_version;
}

constexpr std::string_view damaged =
    "the checkpoint is damaged or truncated, and resuming from it would give a wrong result. Use another "
    "copy, or run the scene again.";

Error error_in(const std::string& name, std::string_view what) {
  return fail(ErrorCode::io, "{}: {}", printable_line(name), what);
}

/// What the first bytes alone tell.
Status check_magic(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) return error_in(name, "the file is empty.");
  if (magic.starts_with(bytes.substr(0, magic.size()))) return {};
  return advised(error_in(name, "this is not a checkpoint of Aspic."), {{RemedyKind::give_checkpoint}});
}

/// Whether the state has the fields of this program, in its order. Error (io).
Status check_fields(Decoder& in, const std::string& name) {
  const std::uint64_t count = in.get(4);
  for (std::uint64_t n = 0; n < count; ++n) {
    const std::string_view field = in.text();
    const std::uint64_t carrier = in.get(4), components = in.get(4);
    if (in.failed()) return error_in(name, damaged);
    const bool known = n < state_fields.size() && field == state_fields[n].name &&
                       carrier == static_cast<std::uint64_t>(state_fields[n].carrier) &&
                       components == StateField::components;
    if (!known) {
      return error_in(name, fmt::format("the checkpoint holds a state with the field {}, which this version "
                                        "does not support. Use the version of aspic that wrote it.",
                                        excerpt(field, 40)));
    }
  }
  return count == state_fields.size() ? Status() : error_in(name, damaged);
}

bool is_version_text(std::string_view text) {
  return text.size() <= longest_program_version &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace

Result<Checkpoint> decode_checkpoint(std::string_view bytes, const std::string& name) {
  const auto error = [&](std::string_view what) { return error_in(name, what); };
  ASPIC_CHECK(check_magic(bytes, name));
  Decoder in(bytes);
  in.take(magic.size());
  const auto version = static_cast<std::uint32_t>(in.get(4));
  if (in.failed()) return error(damaged);
  if (!is_read(version)) {
    return error(fmt::format(
        "the checkpoint has format version {}, and this version of Aspic reads versions {} to {}. {}",
        version, oldest_checkpoint_version, checkpoint_version,
        version > checkpoint_version ? "Use the newer version that wrote it."
                                     : "Run the scene again to make a new one."));
  }
  if (bytes.size() < 8) return error(damaged);
  Decoder tail(bytes.substr(bytes.size() - 8));
  if (tail.get(8) != checksum(bytes.substr(0, bytes.size() - 8))) return error(damaged);

  Checkpoint checkpoint;
  State& state = checkpoint.state;
  const std::uint64_t width = in.get(4);
  if (width != 4 && width != 8) return error(damaged);
  state.precision = width == 4 ? Precision::single : Precision::double_;
  state.step = in.get(8);
  checkpoint.timestep = std::bit_cast<double>(in.get(8));
  const std::uint64_t hash = in.get(8);
  const std::string_view program_version = in.text(), scene = in.text(),
                         inputs = version >= first_with_inputs ? in.text() : std::string_view();
  if (version >= first_with_fields) ASPIC_CHECK(check_fields(in, name));
  const std::uint64_t particles = in.get(8);
  const std::uint64_t balls = in.get(8);
  if (!is_version_text(program_version) || scene.size() > longest_scene || inputs.size() > longest_inputs ||
      state.step > last_checkpoint_step || !(checkpoint.timestep > 0.0 && std::isfinite(checkpoint.timestep)))
    return error(damaged);
  // Sizes are compared before anything is allocated: 6 numbers a particle, 9 a ball and the checksum must be
  // all that is left.
  if (in.failed() || particles > bytes.size() || balls > bytes.size() ||
      in.left() !=
          (particles * numbers_of(StateCarrier::particle) + balls * numbers_of(StateCarrier::ball)) * width +
              8)
    return error(damaged);
  checkpoint.program_version = program_version;
  checkpoint.scene = scene;
  checkpoint.inputs = inputs;
  resize(state, particles, balls);
  for_each_vector(state, [&](Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) v[axis] = get_number(in, state.precision);
  });
  if (state_hash(state) != hash || first_not_finite(state)) return error(damaged);
  return checkpoint;
}

Status write_checkpoint(AtomicFile& file, const Checkpoint& checkpoint) {
  ASPIC_CHECK(check_finite(checkpoint.state, file.path()));
  return file.write(encode_checkpoint(checkpoint));
}

Status check_against_scene(const Checkpoint& checkpoint, const ModelSettings& scene,
                           const std::string& name) {
  if (checkpoint.timestep != scene.simulation.timestep) {
    return error_in(name, fmt::format("the checkpoint has a time step of {} s, but the scene in it has {} s: "
                                      "the file was changed. Use another copy, or run the scene again.",
                                      checkpoint.timestep, scene.simulation.timestep));
  }
  const ModelCounts counts = predict_counts(scene);
  const State& state = checkpoint.state;
  if (counts.particles != state.position.size() || counts.balls != state.ball_position.size()) {
    return fail(ErrorCode::scene_rejected,
                "{}: the checkpoint holds {} particles and {} balls, but the scene in it has {} and {}: the "
                "file was changed. Use another copy, or run the scene again.",
                printable_line(name), state.position.size(), state.ball_position.size(), counts.particles,
                counts.balls);
  }
  return {};
}

namespace {

/// Whether the file has the size that its own counts want, which is known without reading it. Error (io): it
/// has not.
Status check_size(const std::string& path, std::uint64_t size, std::uint64_t before_texts) {
  ASPIC_TRY(const auto head, read_regular_file(path, before_texts + 8 + longest_program_version + 8));
  Decoder in(head.content);
  in.take(magic.size());
  const std::uint64_t format = in.get(4), width = in.get(4);
  in.take(before_texts - magic.size() - 8);
  const std::uint64_t version = in.text().size(), scene = in.get(8);
  if (in.failed() || scene > longest_scene) return error_in(path, damaged);
  std::uint64_t counts = before_texts + 8 + version + 8 + scene;
  if (format >= first_with_inputs) {
    ASPIC_TRY(const auto texts, read_regular_file(path, counts + 8));
    Decoder length(
        std::string_view(texts.content).substr(std::min<std::size_t>(counts, texts.content.size())));
    const std::uint64_t inputs = length.get(8);
    if (length.failed() || inputs > longest_inputs) return error_in(path, damaged);
    counts += 8 + inputs + 4;
    for (const StateField& field : state_fields) counts += 8 + field.name.size() + 8;
  }
  ASPIC_TRY(const auto start, read_regular_file(path, counts + 16));
  Decoder numbers(std::string_view(start.content).substr(std::min(counts, start.content.size())));
  const std::uint64_t particles = numbers.get(8), balls = numbers.get(8);
  if (numbers.failed() || particles > size || balls > size ||
      size != counts + 16 +
                  (numbers_of(StateCarrier::particle) * particles + numbers_of(StateCarrier::ball) * balls) *
                      width +
                  8)
    return error_in(path, damaged);
  return {};
}

}  // namespace

Result<Checkpoint> read_checkpoint(const std::string& path) {
  // The first bytes come first: a file that is no checkpoint needs no memory to be refused.
  constexpr std::uint64_t before_texts = magic.size() + 4 + 4 + 3 * 8;  // as encode_checkpoint() writes them
  ASPIC_TRY(const auto start, read_regular_file(path, before_texts));
  Decoder in(start.content);
  if (in.take(magic.size()) != magic || !is_read(static_cast<std::uint32_t>(in.get(4))))
    return decode_checkpoint(start.content, path);  // which says why not
  // Once as bytes, and as doubles whatever the precision in the file.
  const std::optional<std::uint64_t> memory = available_memory();
  if (memory && start.size > *memory / 3) {
    return error_in(path, fmt::format("the checkpoint has {} bytes, and only {} bytes of memory are free.",
                                      start.size, *memory));
  }
  ASPIC_CHECK(check_size(path, start.size, before_texts));
  ASPIC_TRY(const auto bytes, read_regular_file(path, start.size));
  return decode_checkpoint(bytes.content, path);
}

}  // namespace aspic
