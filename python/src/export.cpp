// The class _aspic.Export: motions for other programs, as the library writes them.
#include <nanobind/stl/string.h>

#include <optional>
#include <string>

#include "simulation.h"

namespace aspic::python {
namespace {

/// A file of samples that come one by one. One that failed, or that is gone before finish(), leaves nothing
/// that looks complete.
class Export {
 public:
  Export(const Scene& scene, const std::string& path, bool overwrite)
      : scene_(scene),
        files_(take(RunFiles::open({{"export", path, 1}}, {},
                                   {to_toml(scene), scene.model.simulation.integrator},
                                   overwrite ? Overwrite::allow : Overwrite::refuse))) {}

  /// A simulation's state as it is, with what pulls at it.
  void add(Simulation& simulation) {
    simulation.show([&](const SharedModel& model, State state, const Inputs& inputs) {
      add_sample(model, std::move(state), inputs);
    });
  }
  /// A state of the scene, which nothing pulls at.
  void add_state(const State& state) {
    const Unlocked others;
    if (!of_scene_) of_scene_ = take(make_model(scene_.model));
    add_sample(of_scene_, state, {});
  }
  /// Completes the file with the samples added; nothing without samples or after an error. `warnings`: as
  /// Sample has them.
  void finish(const std::string& warnings) {
    const Unlocked others;
    if (!complete_) return;
    complete_ = false;
    check(files_.finish({.model = *model_, .state = state_, .inputs = &inputs_, .warnings = warnings}));
  }

 private:
  void add_sample(const SharedModel& model, State state, const Inputs& inputs) {
    complete_ = false;
    model_ = model;
    state_ = std::move(state);
    inputs_ = inputs;
    check(files_.take({.model = *model_, .state = state_, .inputs = &inputs_}));
    if (!files_.failures().empty()) throw LibraryError(files_.failures().front());
    complete_ = true;
  }

  Scene scene_;
  RunFiles files_;
  SharedModel of_scene_;
  // Of the last sample.
  SharedModel model_;
  State state_;
  Inputs inputs_;
  bool complete_ = false;
};

}  // namespace

void bind_export(nb::module_& module) {
  nb::class_<Export>(module, "Export", "A motion that is written to files, in the format of their ending.")
      .def(nb::init<const Scene&, const std::string&, bool>(), nb::arg("scene"), nb::arg("path"),
           nb::arg("overwrite"))
      .def("add", &Export::add, nb::arg("simulation"), "Add the present state as a sample.")
      .def("add_state", &Export::add_state, nb::arg("state"), "Add a state as a sample.")
      .def("finish", &Export::finish, nb::arg("warnings"), "Complete the files.");
}

}  // namespace aspic::python
