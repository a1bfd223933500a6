// The extension module aspic._aspic: libaspic as Python sees it. What users meet is python/aspic.
#include <aspic/version.h>

#include <filesystem>

#include "convert.h"

namespace aspic::python {
namespace {

void raise(ErrorCode code, const char* text) {
  const nb::object made =
      nb::module_::import_("aspic._errors").attr("error_of")(static_cast<int>(code), text);
  PyErr_SetObject(made.type().ptr(), made.ptr());
}

}  // namespace

void register_errors() {
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const LibraryError& e) {
      raise(e.code(), e.what());
    } catch (const std::filesystem::filesystem_error& e) {  // the working directory is gone, say
      raise(ErrorCode::io, e.what());
    }
  });
}

}  // namespace aspic::python

NB_MODULE(_aspic, module) {
  using namespace aspic::python;
  // At the interpreter's end modules may still hold simulations.
  nb::set_leak_warnings(false);
  module.doc() = "Bindings of libaspic for the package aspic.";
  module.attr("version") = ASPIC_VERSION;
  register_errors();
  module.def("end", &Unlocked::end, "End running calls; for atexit.");
  bind_scene(module);
  bind_state(module);
  bind_simulation(module);
  bind_batch(module);
  bind_sweep(module);
  bind_export(module);
}
