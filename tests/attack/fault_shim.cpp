// A library for LD_PRELOAD that makes the n-th allocation, file operation or pass of the program fail, or
// ends the program there. Counting begins with main(); programs that it starts are left alone.
//
//   ASPIC_FAULT=KIND:N[+][:WHAT]   strikes at the N-th chance, from 1; with + at every one from the N-th on
//   ASPIC_FAULT_LOG=FILE           gets "struck NAME" at the first strike, and the counts at the end
//
// KIND alloc    malloc and its family, whoever calls                  fails
//      own      operator new and malloc, no driver being at work       fails
//      file     file operations                                       WHAT: an errno (EIO by default), or
//      kill disk     those alone that need room on the disk                WHAT: as above (ENOSPC by default)
//      short    write() and send() take a third of what is offered    N is not looked at
//      pass     dispatches, draws and read-backs: the device is lost  later ones are dropped, reads give 0xff
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <unwind.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <new>

namespace {

enum Kind { alloc, own, file, disk, shortened, pass, kinds };
constexpr const char* kind_names[kinds] = {"alloc", "own", "file", "disk", "short", "pass"};

// Plain data: this runs before any constructor of the program, and inside malloc.
std::atomic<bool> armed{false}, device_lost{false}, logged{false};
std::atomic<long> counts[kinds];
Kind chosen = kinds;
long strike_at = 0;
bool and_on = false, kills = false;
int error_number = 0;
char log_path[4096];
struct Range {
  std::uintptr_t begin, end;
} program_range, library_range;
// What was loaded when the program started: all else is a driver, or code that one made.
Range known[128];
int known_count = 0;

bool inside(const Range& range, const void* address) {
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  return at >= range.begin && at < range.end;
}

/// Where the program and the C++ library are: what they call counts, what a driver calls does not.
int find_ranges(dl_phdr_info* info, std::size_t, void*) {
  Range range = {UINTPTR_MAX, 0};
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& header = info->dlpi_phdr[i];
    if (header.p_type != PT_LOAD || (header.p_flags & PF_X) == 0) continue;
    const std::uintptr_t begin = info->dlpi_addr + header.p_vaddr;
    if (begin < range.begin) range.begin = begin;
    if (begin + header.p_memsz > range.end) range.end = begin + header.p_memsz;
  }
  if (known_count < 128) known[known_count++] = range;
  if (info->dlpi_name[0] == '\0' && program_range.end == 0) program_range = range;
  if (strstr(info->dlpi_name, "libstdc++") != nullptr) library_range = range;
  return 0;
}

/// Straight to the system, since the functions of these names are ours.
void note(const char* text) {
  if (log_path[0] == '\0') return;
  const long descriptor = syscall(SYS_openat, AT_FDCWD, log_path, O_WRONLY | O_CREAT | O_APPEND, 0600);
  if (descriptor < 0) return;
  (void)!syscall(SYS_write, descriptor, text, strlen(text));
  syscall(SYS_close, descriptor);
}

/// Whether a chance is the one. Sets errno where it is; does not return where the strike is a kill.
bool strikes(Kind kind, const char* name) {
  if (!armed.load(std::memory_order_relaxed)) return false;
  const long n = ++counts[kind];
  if (kind != chosen || (and_on ? n < strike_at : n != strike_at)) return false;
  if (!logged.exchange(true)) {
    char line[128] = "struck ";
    strncat(line, name, 100);
    strcat(line, "\n");
    note(line);
  }
  if (kills) {
    syscall(SYS_kill, getpid(), SIGKILL);
    for (;;) pause();
  }
  errno = error_number;
  return true;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

int number_of(const char* name) {
  if (strcmp(name, "ENOSPC") == 0) return ENOSPC;
  if (strcmp(name, "EMFILE") == 0) return EMFILE;
  if (strcmp(name, "EINTR") == 0) return EINTR;
  return EIO;
}

void read_orders() {
  dl_iterate_phdr(find_ranges, nullptr);
  if (const char* path = getenv("ASPIC_FAULT_LOG")) strncpy(log_path, path, sizeof log_path - 1);
  const char* order = getenv("ASPIC_FAULT");
  for (int kind = 0; order && kind < kinds; ++kind) {
    const std::size_t length = strlen(kind_names[kind]);
    if (strncmp(order, kind_names[kind], length) != 0 || order[length] != ':') continue;
    chosen = static_cast<Kind>(kind);
    char* rest = nullptr;
    strike_at = strtol(order + length + 1, &rest, 10);
    and_on = *rest == '+';
    if (and_on) ++rest;
    error_number = kind == disk ? ENOSPC : kind == file ? EIO : ENOMEM;
    kills = *rest == ':' && strcmp(rest + 1, "kill") == 0;
    if (*rest == ':') error_number = number_of(rest + 1);
  }
  // The program's own children, ffmpeg say, are none of ours.
  unsetenv("LD_PRELOAD");
  unsetenv("ASPIC_FAULT");
  unsetenv("ASPIC_FAULT_LOG");
}

[[gnu::destructor]] void report() {
  char line[256];
  const int length =
      snprintf(line, sizeof line, "alloc %ld own %ld file %ld disk %ld pass %ld\n", counts[alloc].load(),
               counts[own].load(), counts[file].load(), counts[disk].load(), counts[pass].load());
  if (length > 0) note(line);
}

using Main = int (*)(int, char**, char**);
Main program_main = nullptr;

int main_with_faults(int argc, char** argv, char** environment) {
  read_orders();
  armed = true;
  const int code = program_main(argc, argv, environment);
  armed = false;
  return code;
}

_Unwind_Reason_Code look_at_frame(_Unwind_Context* context, void* found) {
  const auto* const at = reinterpret_cast<const void*>(_Unwind_GetIP(context));
  if (at == nullptr) return _URC_END_OF_STACK;
  for (int i = 0; i < known_count; ++i) {
    if (inside(known[i], at)) return _URC_NO_REASON;
  }
  *static_cast<bool*>(found) = true;
  return _URC_END_OF_STACK;
}

/// Whether a driver is among the callers. Drivers share functions of std::string with the program, so that
/// the nearest caller alone does not tell.
bool in_a_driver() {
  bool found = false;
  _Unwind_Backtrace(look_at_frame, &found);
  return found;
}

bool ours(const void* caller) {
  return inside(program_range, caller) || inside(library_range, caller);
}

/// A file operation; `needs_room`: one that a full disk can refuse.
bool file_strikes(const void* caller, const char* name, bool needs_room) {
  if (!armed.load(std::memory_order_relaxed) || !ours(caller)) return false;
  const bool full = needs_room && strikes(disk, name);
  return strikes(file, name) || full;
}

bool allocation_strikes(const void* caller) {
  if (!armed.load(std::memory_order_relaxed)) return false;
  const bool mine = inside(program_range, caller) && !in_a_driver() && strikes(own, "malloc");
  return strikes(alloc, "malloc") || mine;
}

}  // namespace

#define CALLER __builtin_return_address(0)

extern "C" {

int __libc_start_main(Main main, int argc, char** argv, int (*init)(int, char**, char**), void (*fini)(),
                      void (*rtld)(), void* stack) {
  program_main = main;
  using Start = int (*)(Main, int, char**, int (*)(int, char**, char**), void (*)(), void (*)(), void*);
  return next<Start>("__libc_start_main")(main_with_faults, argc, argv, init, fini, rtld, stack);
}

// ---- memory ----

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t bytes) {
  return allocation_strikes(CALLER) ? nullptr : __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) {
  return allocation_strikes(CALLER) ? nullptr : __libc_calloc(count, bytes);
}
void* realloc(void* old, std::size_t bytes) {
  return allocation_strikes(CALLER) ? nullptr : __libc_realloc(old, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  return allocation_strikes(CALLER) ? nullptr : __libc_memalign(alignment, bytes);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t bytes) {
  if (allocation_strikes(CALLER)) return ENOMEM;
  *out = __libc_memalign(alignment, bytes);
  return *out ? 0 : ENOMEM;
}

// ---- files ----

int open(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(list, mode_t) : 0;
  va_end(list);
  if (file_strikes(CALLER, "open", (flags & O_CREAT) != 0)) return -1;
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}
FILE* fopen64(const char* path, const char* mode) {
  if (file_strikes(CALLER, "fopen", false)) return nullptr;
  return next<FILE* (*)(const char*, const char*)>("fopen64")(path, mode);
}
FILE* fopen(const char* path, const char* mode) {
  if (file_strikes(CALLER, "fopen", false)) return nullptr;
  return next<FILE* (*)(const char*, const char*)>("fopen")(path, mode);
}
ssize_t read(int descriptor, void* into, std::size_t bytes) {
  return file_strikes(CALLER, "read", false) ? -1 : syscall(SYS_read, descriptor, into, bytes);
}
ssize_t write(int descriptor, const void* from, std::size_t bytes) {
  if (file_strikes(CALLER, "write", true)) return -1;
  if (chosen == shortened && ours(CALLER) && bytes > 3) bytes /= 3;
  return syscall(SYS_write, descriptor, from, bytes);
}
ssize_t send(int descriptor, const void* from, std::size_t bytes, int flags) {
  if (file_strikes(CALLER, "send", false)) return -1;
  if (chosen == shortened && ours(CALLER) && bytes > 3) bytes /= 3;
  return syscall(SYS_sendto, descriptor, from, bytes, flags, nullptr, 0);
}
int close(int descriptor) {
  const bool failed = file_strikes(CALLER, "close", true);
  const long closed = syscall(SYS_close, descriptor);
  if (failed) errno = error_number;
  return failed ? -1 : static_cast<int>(closed);
}
int fsync(int descriptor) {
  return file_strikes(CALLER, "fsync", true) ? -1 : static_cast<int>(syscall(SYS_fsync, descriptor));
}
int fchmod(int descriptor, mode_t mode) {
  return file_strikes(CALLER, "fchmod", false) ? -1 : static_cast<int>(syscall(SYS_fchmod, descriptor, mode));
}
int rename(const char* from, const char* to) {
  return file_strikes(CALLER, "rename", true) ? -1 : static_cast<int>(syscall(SYS_rename, from, to));
}
int link(const char* from, const char* to) {
  return file_strikes(CALLER, "link", true) ? -1 : static_cast<int>(syscall(SYS_link, from, to));
}
int unlink(const char* path) {
  return file_strikes(CALLER, "unlink", false) ? -1 : static_cast<int>(syscall(SYS_unlink, path));
}
int mkdir(const char* path, mode_t mode) {
  return file_strikes(CALLER, "mkdir", true) ? -1 : static_cast<int>(syscall(SYS_mkdir, path, mode));
}
int memfd_create(const char* name, unsigned flags) noexcept {
  return file_strikes(CALLER, "memfd_create", false)
             ? -1
             : static_cast<int>(syscall(SYS_memfd_create, name, flags));
}
int socketpair(int domain, int type, int protocol, int ends[2]) noexcept {
  return file_strikes(CALLER, "socketpair", false)
             ? -1
             : static_cast<int>(syscall(SYS_socketpair, domain, type, protocol, ends));
}
int posix_spawnp(pid_t* pid, const char* program, const posix_spawn_file_actions_t* actions,
                 const posix_spawnattr_t* attributes, char* const arguments[], char* const environment[]) {
  if (file_strikes(CALLER, "posix_spawnp", false)) return error_number;
  using Spawn = int (*)(pid_t*, const char*, const posix_spawn_file_actions_t*, const posix_spawnattr_t*,
                        char* const[], char* const[]);
  return next<Spawn>("posix_spawnp")(pid, program, actions, attributes, arguments, environment);
}

}  // extern "C"

void* operator new(std::size_t bytes) {
  if (armed.load(std::memory_order_relaxed)) {
    const bool mine = inside(program_range, CALLER) && !in_a_driver() && strikes(own, "operator new");
    if (strikes(alloc, "operator new") || mine) throw std::bad_alloc();
  }
  if (void* made = __libc_malloc(bytes ? bytes : 1)) return made;
  throw std::bad_alloc();
}

// ---- OpenGL ----

namespace {

void (*real_dispatch)(unsigned, unsigned, unsigned);
void (*real_dispatch_indirect)(std::ptrdiff_t);
void (*real_draw_arrays)(unsigned, int, int);
void (*real_draw_elements)(unsigned, int, unsigned, const void*);
void (*real_read_pixels)(int, int, int, int, unsigned, unsigned, void*);
void (*real_get_buffer)(unsigned, std::ptrdiff_t, std::ptrdiff_t, void*);
void* (*real_map_buffer)(unsigned, std::ptrdiff_t, std::ptrdiff_t, unsigned);
unsigned (*real_reset_status)();

/// A pass on its way: false if the device is lost, or is lost by it.
bool passes(const char* name) {
  if (strikes(pass, name)) device_lost = true;
  return !device_lost;
}
void dispatch(unsigned x, unsigned y, unsigned z) {
  if (passes("glDispatchCompute")) real_dispatch(x, y, z);
}
void dispatch_indirect(std::ptrdiff_t offset) {
  if (passes("glDispatchComputeIndirect")) real_dispatch_indirect(offset);
}
void draw_arrays(unsigned mode, int first, int count) {
  if (passes("glDrawArrays")) real_draw_arrays(mode, first, count);
}
void draw_elements(unsigned mode, int count, unsigned type, const void* indices) {
  if (passes("glDrawElements")) real_draw_elements(mode, count, type, indices);
}
void read_pixels(int x, int y, int width, int height, unsigned format, unsigned type, void* into) {
  if (passes("glReadPixels")) real_read_pixels(x, y, width, height, format, type, into);
}
void get_buffer(unsigned target, std::ptrdiff_t offset, std::ptrdiff_t bytes, void* into) {
  if (passes("glGetBufferSubData"))
    real_get_buffer(target, offset, bytes, into);
  else
    memset(into, 0xff, static_cast<std::size_t>(bytes));
}
void* map_buffer(unsigned target, std::ptrdiff_t offset, std::ptrdiff_t bytes, unsigned access) {
  return passes("glMapBufferRange") ? real_map_buffer(target, offset, bytes, access) : nullptr;
}
unsigned reset_status() {
  constexpr unsigned innocent_context_reset = 0x8254;
  return device_lost ? innocent_context_reset : real_reset_status();
}

}  // namespace

extern "C" void* eglGetProcAddress(const char* name) {
  // Of a library that the program loads by itself, so that it is not the next one.
  static void* const library = ::dlopen("libEGL.so.1", RTLD_NOW);
  static const auto real_get =
      reinterpret_cast<void* (*)(const char*)>(::dlsym(library, "eglGetProcAddress"));
  void* const real = real_get(name);
  if (real == nullptr) return real;
  struct Wrapped {
    const char* name;
    void* keep;
    void* ours;
  };
  const Wrapped all[] = {
      {"glDispatchCompute", &real_dispatch, reinterpret_cast<void*>(dispatch)},
      {"glDispatchComputeIndirect", &real_dispatch_indirect, reinterpret_cast<void*>(dispatch_indirect)},
      {"glDrawArrays", &real_draw_arrays, reinterpret_cast<void*>(draw_arrays)},
      {"glDrawElements", &real_draw_elements, reinterpret_cast<void*>(draw_elements)},
      {"glReadPixels", &real_read_pixels, reinterpret_cast<void*>(read_pixels)},
      {"glGetBufferSubData", &real_get_buffer, reinterpret_cast<void*>(get_buffer)},
      {"glMapBufferRange", &real_map_buffer, reinterpret_cast<void*>(map_buffer)},
      {"glGetGraphicsResetStatus", &real_reset_status, reinterpret_cast<void*>(reset_status)},
      {"glGetGraphicsResetStatusKHR", &real_reset_status, reinterpret_cast<void*>(reset_status)}};
  for (const Wrapped& wrapped : all) {
    if (strcmp(name, wrapped.name) != 0) continue;
    memcpy(wrapped.keep, &real, sizeof real);
    return wrapped.ours;
  }
  return real;
}
