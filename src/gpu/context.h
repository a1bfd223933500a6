#pragma once
// An OpenGL 4.3 core context: its own through EGL, without a display, or a window's.
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/fork.h"
#include "base/result.h"
#include "gpu/device_info.h"

namespace aspic::gl {

/// Which device a headless context takes.
enum class DeviceChoice {
  automatic,  ///< hardware before software, then whatever EGL offers
  hardware,   ///< never a software rasterizer
  software,   ///< a software rasterizer alone
  index       ///< ContextOptions::device_index of list_devices()
};

/// Debug builds ask for debug contexts.
#ifdef NDEBUG
inline constexpr bool debug_by_default = false;
#else
inline constexpr bool debug_by_default = true;
#endif

/// How a context is made. The environment variable ASPIC_EGL_DEVICE (automatic, hardware, software,
/// surfaceless, default, or an index) goes before `device`.
struct ContextOptions {
  bool debug = debug_by_default;  ///< ask for KHR_debug messages, synchronously
  bool robust = true;             ///< ask for notice of a lost device; done without where refused
  DeviceChoice device = DeviceChoice::automatic;  ///< which device
  int device_index = 0;                           ///< ≥ 0; read only with DeviceChoice::index
};

/// A device that EGL lists, before any context exists on it.
struct EglDevice {
  int index = 0;          ///< its place in EGL's list: what DeviceChoice::index and ASPIC_EGL_DEVICE take
  std::string name;       ///< renderer, DRM node or vendor, as the driver reports it
  bool software = false;  ///< EGL_MESA_device_software
};

/// Every device of EGL_EXT_device_enumeration, in EGL's order; empty where EGL does not enumerate.
std::vector<EglDevice> list_devices();

/// One KHR_debug message.
struct DebugMessage {
  bool severe = false;  ///< of high severity
  std::uint32_t id = 0;
  std::string text;
};

/// What a driver does on a bad day; see Context::inject_fault.
enum class Fault {
  lost_context,      ///< the device was reset, and all that this context held is gone
  out_of_memory,     ///< an allocation failed
  lost_at_dispatch,  ///< the same as lost_context, at a pass: it and all later ones do nothing
  no_answer,         ///< a wait for the device never ends
  late               ///< the device has not got as far as a poll asks
};

/// What Buffer::download reads at a time [bytes].
inline constexpr std::uint64_t read_part_bytes = std::uint64_t{4} << 20;

struct DeleteFence;
class ProgramCache;
struct EglCandidate;
class ReadRing;

/// The address of a GL function, or null: eglGetProcAddress, glfwGetProcAddress.
using Loader = void (*(*)(const char* name))();

/// How a window system that is not EGL answers for a context of its own, on that context's thread.
struct WindowContext {
  std::function<bool()> is_current;    ///< whether the context is current
  std::function<void()> make_current;  ///< makes it current
};

/// A context and what was found out about its device. Buffers, programs and timers made with it must go
/// before it; a gpu solver sees to that by holding it. GL calls go to the context that is current on the
/// calling thread: whoever makes them enters the context first (gpu/current.h). A context is current on one
/// thread at a time; an adopted one belongs to the thread that adopted it. A child of fork() cannot use those
/// of its parent, nor make its own where there were any: drivers lose their threads. Not movable: the driver
/// keeps its address for messages.
class Context : public std::enable_shared_from_this<Context> {
 public:
  /// A separate context, without a window, current on return.
  /// Error (no_device): says what was tried, what each attempt answered, and what to install.
  static Result<std::shared_ptr<Context>> create_headless(const ContextOptions& options = {});

  /// Takes on the context that is current on this thread, a window's say, without owning it. Debug and
  /// robustness follow from how it was made. A context of EGL is made current again by itself; others need
  /// `window`, or must be current in every call. Error (no_device): none is current, or it is older than
  /// OpenGL 4.3.
  static Result<std::shared_ptr<Context>> adopt_current(Loader loader, WindowContext window = {});

  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes the context current on this thread, where it stays so; nothing happens where it is. Error
  /// (no_device): it is at work on another thread, the process was forked since, or the system refuses.
  Status make_current();
  /// Whether calls of this thread go to this context.
  bool is_current() const;

  /// A context of EGL that was current, with its surfaces; all null: none.
  struct Place {
    void* display = nullptr;
    void* context = nullptr;
    void* draw = nullptr;
    void* read = nullptr;
  };
  /// make_current(), with what it takes the place of, for class Current. Nothing is written where nothing
  /// changes.
  Status enter(Place& before);
  /// Makes current what enter() took the place of.
  static void put_back(const Place& before);

  /// Deletes an object of this context: at once, or, where the context is at work on another thread, as soon
  /// as that thread enters it again.
  using Delete = void (*)(std::uint32_t id);
  void dispose(std::uint32_t id, Delete deletion) noexcept { dispose({nullptr, id, deletion}); }

  const DeviceInfo& info() const { return info_; }

  /// Polls glGetGraphicsResetStatus; once true it stays true. Always false where the context is not robust,
  /// injected faults excepted.
  bool lost();
  /// Whether the driver has failed to allocate (GL_OUT_OF_MEMORY) since this was last asked: drivers may put
  /// an allocation off until the memory is used. Other GL errors found on the way become messages of high
  /// severity.
  bool ran_out_of_memory();
  /// Takes pending GL errors off the record.
  void forget_errors();
  /// Error (no_device): the sentence about a lost context.
  Error lost_error() const;
  /// Whether what the device computed is to be trusted. Error (no_device): the context was reset or lost.
  /// Error (`memory_code`): the driver ran out of memory since this, or ran_out_of_memory(), was last asked.
  Status check(ErrorCode memory_code = ErrorCode::no_device);

  /// For tests: the driver's fault strikes at its next chance, or after so many chances have passed. Chances
  /// of lost_context are calls of lost(); those of out_of_memory are the making of a buffer or a texture and
  /// calls of ran_out_of_memory(); those of lost_at_dispatch are the dispatches of passes, and what is
  /// downloaded once it has struck has all bits set; those of no_answer and late are calls of wait_for() and
  /// passed(). No GL call is made for it, so that the context itself keeps working.
  void inject_fault(Fault fault, std::uint64_t after = 0);
  /// For tests: faults that have not struck yet never will, and an injected loss is taken back.
  void take_back_faults();
  /// Dispatches of passes since the context was made.
  std::uint64_t dispatches() const { return dispatches_; }

  /// Called with every message as it comes, none without debug but the errors of ran_out_of_memory(); an
  /// empty function ends that.
  void set_message_sink(std::function<void(const DebugMessage&)> sink) { sink_ = std::move(sink); }

  /// Compute programs that were linked in this context, to be used again.
  ProgramCache& programs() { return *programs_; }

  /// Bytes of device memory that are free, where a hardware device's driver tells (GL_NVX_gpu_memory_info,
  /// GL_ATI_meminfo), or as assumed.
  std::optional<std::uint64_t> free_memory();
  /// For tests: what free_memory() answers from now on; nothing: what the driver tells.
  void assume_free_memory(std::optional<std::uint64_t> bytes) { assumed_free_ = bytes; }
  /// For tests: the limits of another device, no wider than this one's; with small blocks, small scenes take
  /// the ways of large ones.
  void assume_limits(const DeviceLimits& limits) { info_.limits = limits; }
  /// Error (scene_rejected): `bytes` more are needed than are free, as far as the driver tells; the sentence
  /// gives the figures.
  Status check_memory(std::uint64_t bytes);

  /// Bytes that this context's buffers hold at present, those included that wait to be deleted.
  std::uint64_t bytes_held() const { return bytes_held_; }

 private:
  friend class Buffer;
  friend class Texture;
  friend class Pass;
  friend class ReadRing;
  friend struct DeleteFence;
  friend bool passed(Context& context, const std::unique_ptr<void, DeleteFence>& fence);
  friend Status wait_for(Context& context, const std::unique_ptr<void, DeleteFence>& fence);
  /// An object that is no longer needed: a GLsync, a name and how to delete it, or the name of a Buffer.
  struct Disposed {
    void* sync = nullptr;
    std::uint32_t id = 0;
    Delete deletion = nullptr;
    std::uint64_t bytes = 0;
  };
  Context();
  /// The context on a candidate. The error says why it does not do.
  static Result<std::shared_ptr<Context>> create_on(const EglCandidate& candidate,
                                                    const ContextOptions& options);
  void start(std::string platform, Loader loader);
  /// Whether an injected fault's time has come; it has only one.
  bool strikes(Fault fault);
  /// What an indexed binding point holds.
  struct Bound {
    unsigned int id = 0;
    std::uint64_t offset = 0, bytes = 0;
    friend bool operator==(const Bound&, const Bound&) = default;
  };
  /// Copies of read_part_bytes on their way back; made when it is first asked for.
  ReadRing& reads();
  void release_objects();
  void note_egl();
  Error elsewhere_error() const;
  void dispose(const Disposed& object) noexcept;
  void remove(const Disposed& object) noexcept;
  void remove_disposed() noexcept;
  /// A pass is about to be dispatched: whether it may.
  bool begins_dispatch();

  Place egl_;  // nothing: a context of another window system
  bool owned_ = false;
  const std::uint64_t forks_ = forks();  // of the process that it was made in
  WindowContext window_;
  std::thread::id thread_;  // that adopted it
  std::mutex disposed_mutex_;
  std::vector<Disposed> disposed_;
  std::atomic<bool> any_disposed_ = false;
  DeviceInfo info_;
  bool lost_ = false;
  unsigned int (*reset_status_)() = nullptr;  // glGetGraphicsResetStatus of a robust context
  std::uint32_t memory_query_ = 0;            // what tells of free memory, or 0
  std::optional<std::uint64_t> assumed_free_;
  bool dead_ = false;                                   // by an injected loss at a dispatch
  bool silent_ = false;                                 // a wait for the device did not end
  std::array<std::optional<std::uint64_t>, 5> faults_;  // by Fault: chances left to let pass
  std::uint64_t dispatches_ = 0;
  std::unique_ptr<ProgramCache> programs_;
  std::uint64_t bytes_held_ = 0;
  std::unique_ptr<ReadRing> reads_;
  // Storage and uniform binding points, so that nothing is bound where it is already.
  std::array<std::array<Bound, 16>, 2> bound_ = {};
  std::function<void(const DebugMessage&)> sink_;
};

}  // namespace aspic::gl
