#pragma once
// What a GL device is called and how much it takes.
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace aspic::gl {

/// The limits that the solver has to live within, as the device states them. Sizes in bytes.
struct DeviceLimits {
  std::uint64_t storage_block_bytes = 0;          ///< GL_MAX_SHADER_STORAGE_BLOCK_SIZE; 16 MiB guaranteed
  std::uint64_t buffer_bytes = 0;                 ///< of one buffer; Mesa counts its bytes in 32 bits
  std::uint64_t uniform_block_bytes = 0;          ///< GL_MAX_UNIFORM_BLOCK_SIZE; 16 KiB guaranteed
  std::uint32_t compute_storage_blocks = 0;       ///< GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS; 8 guaranteed
  std::uint32_t vertex_storage_blocks = 0;        ///< GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS; 0 guaranteed
  std::uint32_t group_invocations = 0;            ///< GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS; 1,024 guaranteed
  std::array<std::uint32_t, 3> group_count = {};  ///< GL_MAX_COMPUTE_WORK_GROUP_COUNT; 65,535 each guaranteed
  std::array<std::uint32_t, 3> group_size = {};   ///< GL_MAX_COMPUTE_WORK_GROUP_SIZE
  std::uint32_t shared_bytes = 0;                 ///< GL_MAX_COMPUTE_SHARED_MEMORY_SIZE; 32 KiB guaranteed
  std::uint32_t storage_offset_alignment = 0;     ///< GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT
  std::uint32_t uniform_offset_alignment = 0;     ///< GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT
};

/// One device, as the driver describes it.
struct DeviceInfo {
  std::string vendor;        ///< GL_VENDOR
  std::string renderer;      ///< GL_RENDERER
  std::string version;       ///< GL_VERSION
  std::string glsl_version;  ///< GL_SHADING_LANGUAGE_VERSION
  std::string platform;      ///< how the context was reached, e.g. "EGL device 0" or "window"
  bool is_software = false;  ///< a software rasterizer, by its renderer's name
  bool debug = false;        ///< the context reports through KHR_debug
  bool robust = false;       ///< the context reports a lost device
  DeviceLimits limits;
};

/// Whether a GL_RENDERER names a software rasterizer (llvmpipe, softpipe, swrast, lavapipe, SwiftShader, …).
bool is_software_renderer(std::string_view renderer);

/// Reads vendor, renderer, versions and limits of the current context; platform, debug and robust stay the
/// caller's.
DeviceInfo query_device_info();

/// The lines that `aspic info` prints, without line ends.
std::vector<std::string> describe(const DeviceInfo& info);

}  // namespace aspic::gl
