#include "io/export_npz.h"

#include <fmt/format.h>

#include <bit>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "aspic/analysis.h"
#include "io/motion_sink.h"
#include "io/spool.h"
#include "io/zip_writer.h"
#include "model/springs.h"

namespace aspic {
namespace {

static_assert(std::endian::native == std::endian::little, "the arrays are said to be little-endian");

using Extents = std::vector<std::uint64_t>;

template <class T>
constexpr std::string_view type_of() {
  if constexpr (std::is_same_v<T, float>) return "<f4";
  if constexpr (std::is_same_v<T, double>) return "<f8";
  if constexpr (std::is_same_v<T, std::int64_t>) return "<i8";
  if constexpr (std::is_same_v<T, std::int32_t>) return "<i4";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "<u4";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "|u1";
}

/// What an .npy file begins with. Source: numpy.lib.format, version 1.0.
std::string npy_head(std::string_view type, const Extents& extents) {
  std::string head = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}", type,
                                 fmt::join(extents, ","), extents.empty() ? "" : ",");
  constexpr std::size_t before = 10, aligned = 64;
  head.append(aligned - 1 - (before + head.size()) % aligned, ' ');
  head += '\n';
  const auto size = static_cast<std::uint16_t>(head.size());
  std::string all = "\x93NUMPY";
  all += {'\1', '\0', static_cast<char>(size & 0xff), static_cast<char>(size >> 8)};
  return all + head;
}

template <class T>
std::string_view bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// An array that does not change: complete, as a member of the archive.
Status write_array(ZipWriter& zip, const std::string& name, const std::string& head, std::string_view bytes) {
  ASPIC_CHECK(zip.begin(name + ".npy", head.size() + bytes.size(), crc_of(bytes, crc_of(head))));
  ASPIC_CHECK(zip.write(head));
  return zip.write(bytes);
}

template <class T>
Status write_array(ZipWriter& zip, const std::string& name, const Extents& extents,
                   const std::vector<T>& values) {
  return write_array(zip, name, npy_head(type_of<T>(), extents), bytes_of(std::span(values)));
}

/// Arrays over time: each sample is a record of all of them, one after the other, in the spool.
class Columns {
 public:
  explicit Columns(Spool spool) : spool_(std::move(spool)) {}

  /// The next array of a sample, of these extents in each; the arrays of all samples are the same in their
  /// order.
  template <class T>
  void add(std::string_view name, const Extents& extents, const std::vector<T>& values) {
    const std::string_view bytes = bytes_of(std::span(values));
    if (at_ == columns_.size())
      columns_.push_back({std::string(name), type_of<T>(), extents, record_.size(), bytes.size(), 0});
    columns_[at_].sum = crc_of(bytes, columns_[at_].sum);
    ++at_;
    record_ += bytes;
  }
  /// Error (io).
  Status end_sample() {
    at_ = 0;
    ++samples_;
    record_size_ = record_.size();
    const Status appended = spool_.append(record_);
    record_.clear();
    return appended;
  }
  /// All as members. Error (io).
  Status write(ZipWriter& zip) const {
    std::string bytes;
    for (const Column& c : columns_) {
      Extents extents = {samples_};
      extents.insert(extents.end(), c.extents.begin(), c.extents.end());
      const std::string head = npy_head(c.type, extents);
      const std::uint64_t size = samples_ * c.size;
      ASPIC_CHECK(zip.begin(c.name + ".npy", head.size() + size, joined_crc_of(crc_of(head), c.sum, size)));
      ASPIC_CHECK(zip.write(head));
      for (std::uint64_t sample = 0; sample < samples_; ++sample) {
        bytes.resize(c.size);
        ASPIC_CHECK(spool_.read(sample * record_size_ + c.offset, bytes));
        ASPIC_CHECK(zip.write(bytes));
      }
    }
    return {};
  }

 private:
  struct Column {
    std::string name;
    std::string_view type;
    Extents extents;           // in a sample
    std::size_t offset, size;  // in a record [bytes]
    std::uint32_t sum;         // of what there is so far
  };
  Spool spool_;
  std::vector<Column> columns_;
  std::string record_;
  std::size_t at_ = 0, record_size_ = 0;
  std::uint64_t samples_ = 0;
};

template <class T>
std::vector<T> as_type(std::span<const Vec3> vectors) {
  std::vector<T> numbers;
  numbers.reserve(3 * vectors.size());
  for (const Vec3& v : vectors)
    for (const double x : {v.x, v.y, v.z}) numbers.push_back(static_cast<T>(x));
  return numbers;
}

template <class T>
std::vector<T> as_type(const std::vector<double>& values) {
  return std::vector<T>(values.begin(), values.end());
}

/// A state and what follows from it, in the precision of the run.
template <class T>
void add_state(Columns& columns, const Sample& sample) {
  const State& state = sample.state;
  const std::uint64_t n = state.position.size(), b = state.ball_position.size();
  columns.add("positions", {n, 3}, as_type<T>(state.position));
  columns.add("velocities", {n, 3}, as_type<T>(state.velocity));
  if (b > 0) {
    columns.add("ball-positions", {b, 3}, as_type<T>(state.ball_position));
    columns.add("ball-velocities", {b, 3}, as_type<T>(state.ball_velocity));
    columns.add("ball-angular-velocities", {b, 3}, as_type<T>(state.ball_angular_velocity));
  }
  const StateQuantities q = quantities_of(sample.model, state, inputs_of(sample));
  columns.add("speed", {n}, as_type<T>(q.speed));
  columns.add("mean-strain", {n}, as_type<T>(q.mean_strain));
  columns.add("force", {n, 3}, as_type<T>(q.force));
  columns.add("contact-force", {n, 3}, as_type<T>(q.contact_force));
  columns.add("contact", {n}, q.contact);
  columns.add("strain", {q.strain.size()}, as_type<T>(q.strain));
  columns.add("tension", {q.tension.size()}, as_type<T>(q.tension));
}

void add_sample(Columns& columns, const Sample& sample, Meter& meter, ActuatorWork& actuators) {
  const State& state = sample.state;
  columns.add("steps", {}, std::vector{static_cast<std::int64_t>(state.step)});
  columns.add("time", {}, std::vector{static_cast<double>(state.step) * sample.model.simulation.timestep});
  state.precision == Precision::single ? add_state<float>(columns, sample)
                                       : add_state<double>(columns, sample);
  const Measures m = meter.measure(state, inputs_of(sample));
  columns.add("energy.kinetic", {}, std::vector{m.kinetic});
  columns.add("energy.elastic", {}, std::vector{m.elastic});
  columns.add("energy.gravitational", {}, std::vector{m.gravitational});
  columns.add("momentum", {3}, std::vector{m.momentum.x, m.momentum.y, m.momentum.z});
  if (const auto work = actuators.add(sample.model, state, inputs_of(sample)))
    columns.add("actuator-work", {}, std::vector{*work});
}

/// Which body each particle is of, by global index.
std::vector<std::int32_t> owners(const Model& model) {
  std::vector<std::int32_t> body(model.particle_count(), -1);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    std::fill_n(body.begin() + model.bodies[b].first_particle, model.bodies[b].particle_count,
                static_cast<std::int32_t>(b));
  return body;
}

Status write_springs(ZipWriter& zip, const Model& model) {
  std::vector<std::uint32_t> ends;
  std::vector<std::uint8_t> type, cord;
  std::vector<double> stiffness, damping, rest;
  for (const Spring& s : springs_of(model)) {
    const SpringClass& c = model.spring_classes[s.spring_class];
    ends.insert(ends.end(), {s.a, s.b});
    type.push_back(static_cast<std::uint8_t>(c.type));
    cord.push_back(c.cord ? 1 : 0);
    stiffness.push_back(c.stiffness);
    damping.push_back(c.damping);
    rest.push_back(c.rest_length);
  }
  const std::uint64_t s = type.size();
  ASPIC_CHECK(write_array(zip, "model.springs", {s, 2}, ends));
  ASPIC_CHECK(write_array(zip, "model.spring-type", {s}, type));
  ASPIC_CHECK(write_array(zip, "model.cord", {s}, cord));
  ASPIC_CHECK(write_array(zip, "model.stiffness", {s}, stiffness));
  ASPIC_CHECK(write_array(zip, "model.damping", {s}, damping));
  return write_array(zip, "model.rest-length", {s}, rest);
}

/// Meshes that follow particles: their vertices are Σ weight · position over the corners.
Status write_meshes(ZipWriter& zip, const Model& model) {
  std::vector<std::uint32_t> corners, triangles;
  std::vector<std::int32_t> body;
  std::vector<double> weights;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const BodySkin& mesh = model.bodies[b].skin;
    const auto first = static_cast<std::uint32_t>(body.size());
    body.insert(body.end(), mesh.corners.size(), static_cast<std::int32_t>(b));
    for (const auto& of_vertex : mesh.corners)
      corners.insert(corners.end(), of_vertex.begin(), of_vertex.end());
    for (const SkinVertex& v : mesh.binding.vertices)
      for (const double weight : corner_weights(v.at)) weights.push_back(weight);
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t vertex : t) triangles.push_back(first + vertex);
  }
  if (body.empty()) return {};
  ASPIC_CHECK(write_array(zip, "model.mesh-corners", {body.size(), 8}, corners));
  ASPIC_CHECK(write_array(zip, "model.mesh-weights", {body.size(), 8}, weights));
  ASPIC_CHECK(write_array(zip, "model.mesh-body", {body.size()}, body));
  return write_array(zip, "model.mesh-triangles", {triangles.size() / 3, 3}, triangles);
}

Status write_model(ZipWriter& zip, const Model& model) {
  const std::uint64_t n = model.particle_count(), b = model.ball_count();
  std::vector<std::uint8_t> pinned;
  for (const double w : model.inverse_mass) pinned.push_back(w == 0.0 ? 1 : 0);
  std::vector<std::uint32_t> corners;
  std::vector<std::int32_t> skin_body;
  for (std::size_t body = 0; body < model.bodies.size(); ++body) {
    for (const Quad& quad : surface_of(model.bodies[body]).quads) {
      corners.insert(corners.end(), quad.begin(), quad.end());
      skin_body.push_back(static_cast<std::int32_t>(body));
    }
  }
  std::vector<double> radius, mass;
  for (const Ball& ball : model.balls) {
    radius.push_back(ball.radius);
    mass.push_back(ball.mass);
  }
  ASPIC_CHECK(
      write_array(zip, "model.masses", {n}, std::vector<double>(model.mass.begin(), model.mass.end())));
  ASPIC_CHECK(write_array(zip, "model.pinned", {n}, pinned));
  ASPIC_CHECK(write_array(zip, "model.body", {n}, owners(model)));
  ASPIC_CHECK(write_springs(zip, model));
  ASPIC_CHECK(write_array(zip, "model.skin", {skin_body.size(), 4}, corners));
  ASPIC_CHECK(write_array(zip, "model.skin-body", {skin_body.size()}, skin_body));
  ASPIC_CHECK(write_meshes(zip, model));
  if (b == 0) return {};
  ASPIC_CHECK(write_array(zip, "model.ball-radius", {b}, radius));
  return write_array(zip, "model.ball-mass", {b}, mass);
}

class NpzSeries final : public MotionSink {
 public:
  NpzSeries(const std::string& path, std::uint64_t every, AtomicFile file, Spool spool, std::string scene)
      : MotionSink(path, every),
        file_(std::move(file)),
        columns_(std::move(spool)),
        scene_(std::move(scene)) {}

 private:
  Status add(const Sample& sample) override {
    if (!meter_) meter_.emplace(sample.model);
    add_sample(columns_, sample, *meter_, actuators_);
    return columns_.end_sample();
  }
  Status complete(const Sample& last) override {
    ZipWriter zip(file_);
    ASPIC_CHECK(columns_.write(zip));
    ASPIC_CHECK(write_model(zip, last.model));
    // UTF-8, as bytes of one string.
    const auto write_text = [&](const char* name, const std::string_view text) {
      return write_array(zip, name, npy_head(fmt::format("|S{}", text.size()), {}), text);
    };
    if (!scene_.empty()) ASPIC_CHECK(write_text("scene", scene_));
    if (!last.warnings.empty()) ASPIC_CHECK(write_text("warnings", last.warnings));
    ASPIC_CHECK(zip.finish());
    return file_.commit();
  }

  AtomicFile file_;
  Columns columns_;
  std::optional<Meter> meter_;  // from the first sample on
  ActuatorWork actuators_;
  std::string scene_;
};

}  // namespace

Result<std::unique_ptr<StateSink>> open_npz(const std::string& path, std::uint64_t every, Overwrite overwrite,
                                            const RunFacts& facts) {
  ASPIC_CHECK(check_export_name(path));
  ASPIC_TRY(auto file, AtomicFile::create(path, overwrite));
  ASPIC_TRY(auto spool, Spool::create(path));
  return std::unique_ptr<StateSink>(
      std::make_unique<NpzSeries>(path, every, std::move(file), std::move(spool), facts.scene_toml));
}

}  // namespace aspic
