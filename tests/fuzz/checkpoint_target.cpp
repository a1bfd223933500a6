// Checkpoints. The checksum alone would keep a fuzzer out, so each input is tried with it made right as well.
#include <cstdint>
#include <span>

#include "aspic/scene.h"
#include "base/fnv.h"
#include "fuzz/targets.h"
#include "io/checkpoint.h"
#include "model/counts.h"
#include "model/model.h"

namespace aspic::fuzz {
namespace {

const LoadOptions small = {.memory_bytes = std::uint64_t{1} << 20};
// Places in the header, docs/files.md.
constexpr std::size_t version_at = 10, hash_at = 34, version_text_at = 42;

std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value |= std::uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

void put(std::string& bytes, std::size_t at, std::uint64_t value) {
  for (std::size_t i = 0; i < 8; ++i)
    bytes[at + i] = static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
}

std::uint64_t hash_of(std::string_view bytes) {
  Fnv1a hash;
  hash.add_bytes(std::as_bytes(std::span(bytes)));
  return hash.value();
}

/// Where the numbers of the state begin, or 0 if the lengths before them lead out of the file.
std::size_t state_begin(std::string_view bytes) {
  std::size_t at = version_text_at;
  const int texts = number_at(bytes, version_at, 4) >= 3 ? 3 : 2;
  for (int text = 0; text < texts; ++text) {
    if (at + 8 > bytes.size()) return 0;
    const std::uint64_t length = number_at(bytes, at, 8);
    if (length > bytes.size() - at - 8) return 0;
    at += 8 + static_cast<std::size_t>(length);
  }
  if (texts == 3) {
    at += 4;
    for (const StateField& field : state_fields) at += 8 + field.name.size() + 8;
  }
  return at + 16 + 8 <= bytes.size() ? at + 16 : 0;
}

/// The same bytes with the state's hash and the checksum that belong to them.
std::string repaired(std::string_view bytes) {
  std::string whole(bytes);
  if (whole.size() < version_text_at + 8) return whole;
  if (const std::size_t begin = state_begin(whole))
    put(whole, hash_at, hash_of(std::string_view(whole).substr(begin, whole.size() - 8 - begin)));
  put(whole, whole.size() - 8, hash_of(std::string_view(whole).substr(0, whole.size() - 8)));
  return whole;
}

void demand(std::string_view bytes) {
  const auto read = decode_checkpoint(bytes, "fuzz.aspic");
  if (!read) return require_message(read.error(), {ErrorCode::io});
  if (number_at(bytes, version_at, 4) == checkpoint_version)
    require(encode_checkpoint(*read) == bytes, "an accepted checkpoint is written as it was read");
  const auto scene = parse_scene(read->scene, "fuzz.aspic", {}, small);
  if (!scene) return require_message(scene.error(), {ErrorCode::scene_rejected});
  const auto model = build_model(scene->model);
  if (!model) return require_message(model.error(), {ErrorCode::scene_rejected});
  if (const Status fits = check_sizes(*model, read->state); !fits)
    require_message(fits.error(), {ErrorCode::usage});
  const auto inputs = parse_inputs(read->inputs, "fuzz.aspic", {scene->model, *model});
  if (!inputs) require_message(inputs.error(), {ErrorCode::scene_rejected});
}

void run(std::string_view bytes) {
  demand(bytes);
  demand(repaired(bytes));
}

std::vector<std::string> seeds() {
  std::vector<std::string> made;
  const std::vector<std::string> few = {"cube[0].particles-per-edge=2"};
  for (const char* name : {"cube-plane", "cube-and-balls"}) {
    const auto scene = load_scene(name, few);
    if (!scene) continue;
    const auto model = build_model(scene->model);
    if (!model) continue;
    for (const Precision precision : {Precision::single, Precision::double_})
      made.push_back(encode_checkpoint({"0.2.0", to_toml(*scene), model->simulation.timestep,
                                        initial_state(*model, precision),
                                        "timestep = 0.001\n[[inputs]]\nstep = 3\npinned = [0]\n"}));
  }
  return made;
}

}  // namespace

const Target checkpoint_target = {"checkpoint", run, seeds, scene_words};

}  // namespace aspic::fuzz
