// The classes _aspic.Batch and _aspic.Instance.
#include <aspic/parameters.h>
#include <aspic/state.h>

#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "batch.h"
#include "reading.h"

namespace aspic::python {
namespace {

using Numbers = std::optional<Array<double>>;
/// Times (n, t), centers of mass, momenta, energies (n, t, 3), work (n, t), positions (n, t, p, 3),
/// divergences (n,).
using RecordArrays = std::tuple<Array<double>, Numbers, Numbers, Numbers, Numbers,
                                std::optional<Array<float>>, Array<std::uint64_t>, std::vector<std::string>>;

/// As state_hash_text() writes it.
std::string text_of(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

RecordArrays run(Batch& batch, double duration, double interval, bool center_of_mass, bool momentum,
                 bool energies, bool work, std::optional<std::size_t> body) {
  BatchRecord record = batch.run(duration, interval, {center_of_mass, momentum, energies, body, work});
  const std::size_t n = record.instances, t = record.times;
  const auto vectors = [&](bool wanted, std::vector<double>& numbers) -> Numbers {
    if (!wanted) return std::nullopt;
    return as_array(std::move(numbers), {n, t, 3});
  };
  Numbers works;
  if (work) works = as_array(std::move(record.actuator_work), {n, t});
  std::optional<Array<float>> positions;
  if (body) positions = as_array(std::move(record.positions), {n, t, record.particles, 3});
  std::vector<std::string> hashes;
  for (const std::uint64_t hash : record.hash) hashes.push_back(text_of(hash));
  return RecordArrays(as_array(std::move(record.time), {n, t}),
                      vectors(center_of_mass, record.center_of_mass), vectors(momentum, record.momentum),
                      vectors(energies, record.energy), std::move(works), std::move(positions),
                      as_array(std::move(record.diverged), {n}), std::move(hashes));
}

/// A number of each instance.
template <class F>
auto of_each(Batch& batch, const F& number) {
  return batch.alone([&](Contents& contents) {
    std::vector<decltype(number(contents, std::size_t{}))> all;
    for (std::size_t i = 0; i < contents.batch.size(); ++i) all.push_back(number(contents, i));
    return all;
  });
}

template <class T>
Array<T> as_row(std::vector<T> numbers) {
  const std::size_t count = numbers.size();
  return as_array(std::move(numbers), {count});
}

Array<std::uint64_t> steps(Batch& batch) {
  return as_row(of_each(batch, [](Contents& c, std::size_t i) { return take(c.batch.read_into(i, {})); }));
}

Array<double> times(Batch& batch) {
  return as_row(of_each(batch, [](Contents& c, std::size_t i) {
    return static_cast<double>(take(c.batch.read_into(i, {}))) * c.scenes[i]->model.simulation.timestep;
  }));
}

Array<std::uint64_t> diverged(Batch& batch) {
  return as_row(of_each(batch, [](Contents& c, std::size_t i) {
    const auto divergence = take(c.batch.divergence(i));
    return divergence ? divergence->step : std::uint64_t{0};
  }));
}

std::vector<std::string> hashes(Batch& batch) {
  return of_each(batch, [](Contents& c, std::size_t i) { return state_hash_text(take(c.batch.state(i))); });
}

std::vector<std::vector<std::string>> bodies(Batch& batch) {
  return of_each(batch, [](Contents& c, std::size_t i) { return body_names(c.scenes[i]->model); });
}

Array<float> gather(Batch& batch, std::size_t field) {
  check_field(field);
  Gathered all = batch.gather(field);
  return as_array(std::move(all.numbers), {all.instances, all.vectors, 3});
}

using Mask = nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

void reset(Batch& batch, const std::optional<Mask>& mask) {
  batch.alone([&](Contents& contents) {
    check(mask ? contents.batch.reset({mask->data(), mask->size()}) : contents.batch.reset());
  });
}

}  // namespace

void bind_batch(nb::module_& module) {
  nb::class_<Instance> instance(module, "Instance", "One instance of a batch.");
  bind_reading(instance);
  instance
      .def(
          "load", [](Instance& i, const State& state, const InputLog* log) { i.load(state, log); },
          nb::arg("state"), nb::arg("log").none(), "Load a state and its inputs.")
      .def("log", &Instance::log, "Return the present inputs.")
      .def("set_scene", &Instance::set_scene, nb::arg("scene"), "Replace the constants of the scene.")
      .def(
          "divergence", [](Instance& i) { return told(i.divergence()); },
          "Divergence of the instance; None without one.");
  nb::class_<Batch>(module, "Batch", "Scenes that advance together.")
      .def(nb::init<std::vector<Scene>, const std::vector<std::size_t>&, unsigned>(), nb::arg("scenes"),
           nb::arg("which"), nb::arg("threads"))
      .def(
          "description", [](Batch& b) { return b.alone([](Contents& c) { return c.batch.description(); }); },
          "Backend and layout, in one line.")
      .def(
          "bytes", [](Batch& b) { return b.alone([](Contents& c) { return c.batch.bytes(); }); },
          "Memory in use [bytes].")
      .def(
          "instance", [](Batch& b, std::size_t number) { return Instance(b, number); }, nb::arg("number"),
          nb::keep_alive<0, 1>(), "Return an instance by its number, which must exist.")
      .def("advance", &Batch::advance, nb::arg("steps"),
           "Advance all instances; return how many have diverged.")
      .def("stop", &Batch::stop, "Interrupt advance() or run() in another thread.")
      .def("run", &run, nb::arg("duration"), nb::arg("interval"), nb::arg("center_of_mass"),
           nb::arg("momentum"), nb::arg("energies"), nb::arg("work"), nb::arg("body").none(),
           "Advance all instances and record them.")
      .def("reset", &reset, nb::arg("mask").none(), "Reset instances to step 0.")
      .def("steps", &steps, "Return the steps since the start, (n,).")
      .def("times", &times, "Return the times, (n,) [s].")
      .def("diverged", &diverged, "Return the steps that failed, (n,); 0: none.")
      .def("hashes", &hashes, "Return the state hashes, (n,).")
      .def("bodies", &bodies, "Return the names of the bodies of each instance.")
      .def("gather", &gather, nb::arg("field"), "Return a field of all instances, (n, p, 3).");
}

}  // namespace aspic::python
