#include <fmt/format.h>

#include "aspic/version.h"
#include "base/printable.h"
#include "cli/commands.h"
#include "cli/json.h"
#include "gpu/canary.h"
#include "gpu/program_files.h"
#include "run/capacity.h"
#include "run/window_host.h"

namespace aspic::cli {
namespace {

std::string_view kind_of(const gl::EglDevice& device) {
  return device.software ? "software" : "hardware";
}

Json json_of(const gl::DeviceInfo& info) {
  const gl::DeviceLimits& l = info.limits;
  return {{"vendor", info.vendor},
          {"renderer", info.renderer},
          {"version", info.version},
          {"glsl_version", info.glsl_version},
          {"platform", info.platform},
          {"software", info.is_software},
          {"robust", info.robust},
          {"limits", Json{{"storage_block_bytes", l.storage_block_bytes},
                          {"uniform_block_bytes", l.uniform_block_bytes},
                          {"compute_storage_blocks", l.compute_storage_blocks},
                          {"vertex_storage_blocks", l.vertex_storage_blocks},
                          {"group_invocations", l.group_invocations},
                          {"group_count", l.group_count},
                          {"group_size", l.group_size},
                          {"shared_bytes", l.shared_bytes},
                          {"storage_offset_alignment", l.storage_offset_alignment},
                          {"uniform_offset_alignment", l.uniform_offset_alignment}}}};
}

/// What the canary kernel finds out about the device's arithmetic, and what is done about it.
std::vector<std::string> arithmetic_sentences(gl::Context& context) {
  const auto directory = gl::shader_directory();
  if (!directory) return {worded(directory.error(), FrontEnd::command_line)};
  const auto arithmetic = gl::choose_arithmetic(context, gl::ShaderLibrary(*directory));
  if (!arithmetic)
    return {"Cannot measure the arithmetic: " + worded(arithmetic.error(), FrontEnd::command_line)};
  return arithmetic->sentences();
}

std::string memory_words(const std::optional<std::uint64_t>& free_bytes) {
  if (!free_bytes) return "the driver does not report free memory";
  return human_bytes(*free_bytes) + " free";
}

Json json_of(const gl::ProgramFiles& files) {
  if (files.folder().empty()) return {};
  return {{"folder", files.folder().string()}, {"bytes", files.bytes()}};
}

std::string words_for(const gl::ProgramFiles& files) {
  if (files.folder().empty()) return "none (ASPIC_SHADER_CACHE is off, or there is no home directory)";
  return fmt::format("{}, {}", printable_line(files.folder().string()), human_bytes(files.bytes()));
}

}  // namespace

Status execute(const InfoOptions& options) {
  const std::vector<gl::EglDevice> devices = gl::list_devices();
  AutomaticChoice automatic = choose_automatically({});
  const std::string_view chosen = automatic.row->name;
  const gl::ProgramFiles shader_cache(gl::program_folder());
  // The device that --backend gpu would take: the hardware found just now, or whatever else there is.
  std::shared_ptr<gl::Context> context = std::move(automatic.context);
  std::string no_context;
  if (!context) {
    auto made = gl::Context::create_headless();
    if (made) {
      context = std::move(*made);
    } else {
      no_context = worded(made.error(), FrontEnd::command_line);
    }
  }
  const std::vector<std::string> arithmetic =
      context ? arithmetic_sentences(*context) : std::vector<std::string>{};
  std::optional<std::uint64_t> free_memory;
  if (context) free_memory = free_bytes(*context);
  if (options.json) {
    Json list = Json::array(), rows = Json::array();
    for (const gl::EglDevice& device : devices)
      list.push_back({{"index", device.index}, {"name", device.name}, {"software", device.software}});
    for (const BackendRow& row : backends()) {
      Json precisions = Json::array();
      for (const Precision precision : row.precisions) precisions.push_back(name_of(precision));
      rows.push_back({{"name", row.name}, {"summary", row.summary}, {"precisions", precisions}});
    }
    return print_data(to_text({{"version", ASPIC_VERSION},
                               {"backends", rows},
                               {"devices", list},
                               {"gpu", context ? json_of(context->info()) : Json()},
                               {"gpu_free_bytes", or_null(free_memory)},
                               {"gpu_error", context ? Json() : Json(no_context)},
                               {"arithmetic", arithmetic},
                               {"shader_cache", json_of(shader_cache)},
                               {"auto", chosen},
                               {"auto_reason", automatic.reason},
                               {"auto_detail", or_null(automatic.detail)}}));
  }
  std::string text = "aspic " ASPIC_VERSION "\n\nBackends\n";
  for (const BackendRow& row : backends()) text += fmt::format("  {:<10} {}\n", row.name, row.summary);
  text += "\n";
  text += devices.empty() ? "EGL lists no devices.\n" : "EGL devices\n";
  for (const gl::EglDevice& device : devices)
    text += fmt::format("  {}  {} ({})\n", device.index, device.name, kind_of(device));
  if (context) {
    text += "\nDevice of --backend gpu\n";
    for (const std::string& line : gl::describe(context->info())) text += "  " + line + "\n";
    text += "  memory          " + memory_words(free_memory) + "\n";
    text += "\nArithmetic and workarounds\n";
    for (const std::string& sentence : arithmetic) text += "  " + sentence + "\n";
  } else {
    text += fmt::format("\nNo usable GL device: {}\n", no_context);
  }
  text += fmt::format("\nShader cache: {}\n", words_for(shader_cache));
  text += fmt::format("\nBackend auto: {}, because {}.\n", chosen, automatic.reason);
  if (!automatic.detail.empty()) text += automatic.detail + "\n";
  return print_text(text);
}

}  // namespace aspic::cli
