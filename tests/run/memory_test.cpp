// What `scene check` says of memory against what is allocated: every allocation of this program is counted.
// The linker sends malloc and its like here (CMakeLists.txt), and operator new is this file's own.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "aspic/scene.h"
#include "model/counts.h"
#include "model/springs.h"
#include "run/backends.h"

namespace {

/// Bytes allocated now and the most there were, and blocks.
std::atomic<std::int64_t> held = 0, most_held = 0, blocks = 0;

void* counted(void* block) {
  if (block == nullptr) return block;
  ++blocks;
  const std::int64_t now = held += static_cast<std::int64_t>(malloc_usable_size(block));
  if (now > most_held) most_held = now;
  return block;
}

void forget(void* block) {
  if (block == nullptr) return;
  --blocks;
  held -= static_cast<std::int64_t>(malloc_usable_size(block));
}

}  // namespace

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* block, std::size_t size);
void __real_free(void* block);

void* __wrap_malloc(std::size_t size) {
  return counted(__real_malloc(size));
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  return counted(__real_calloc(count, size));
}
void* __wrap_realloc(void* block, std::size_t size) {
  forget(block);
  return counted(__real_realloc(block, size));
}
void __wrap_free(void* block) {
  forget(block);
  __real_free(block);
}
}

#ifndef __clang__
// At -O1 GCC inlines one half of the pairs below and misses that the other half is ours as well.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif

void* operator new(std::size_t size) {
  if (void* const block = std::malloc(size)) return block;
  throw std::bad_alloc();
}
void* operator new[](std::size_t size) {
  return operator new(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto unit = static_cast<std::size_t>(alignment);
  if (void* const block = counted(std::aligned_alloc(unit, (size + unit - 1) / unit * unit))) return block;
  throw std::bad_alloc();
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return operator new(size, alignment);
}
void operator delete(void* block) noexcept {
  std::free(block);
}
void operator delete[](void* block) noexcept {
  std::free(block);
}
void operator delete(void* block, std::size_t) noexcept {
  std::free(block);
}
void operator delete[](void* block, std::size_t) noexcept {
  std::free(block);
}
void operator delete(void* block, std::align_val_t) noexcept {
  std::free(block);
}
void operator delete[](void* block, std::align_val_t) noexcept {
  std::free(block);
}
void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
  std::free(block);
}
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept {
  std::free(block);
}

namespace aspic {
namespace {

class Memory : public testing::Test {
 protected:
  void SetUp() override {
    // Without this malloc gives large blocks whole pages.
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    held_before_ = held;
    blocks_before_ = blocks;
    most_held = held.load();
  }
  std::int64_t now() const { return held - held_before_; }
  std::int64_t most() const { return most_held - held_before_; }
  /// malloc rounds every block up to 16 bytes and keeps a word of it; names, threads and tables that no
  /// figure counts take a few kilobytes.
  std::int64_t slack() const { return 24 * (blocks - blocks_before_) + 8192; }

 private:
  std::int64_t held_before_ = 0, blocks_before_ = 0;
};

/// In the air, so that no contact comes and goes.
ModelSettings scene(const char* name, std::vector<std::string> changes = {}) {
  auto loaded = load_scene(name, std::move(changes));
  EXPECT_TRUE(loaded.ok()) << loaded.error().message();
  return std::move(loaded->model);
}

std::vector<ModelSettings> scenes() {
  return {scene("cube-plane", {"cube[0].particles-per-edge=30", "cube[0].pinned=['front']"}),
          scene("goal-net", {"goal-net[0].particles=[40, 16, 16]"}), scene("flag")};
}

TEST_F(Memory, OfAModelIsWhatItSays) {
  for (const ModelSettings& settings : scenes()) {
    SetUp();
    const auto model = build_model(settings);
    ASSERT_TRUE(model.ok());
    const auto said = static_cast<std::int64_t>(model_bytes(*model) - sizeof(Model));
    EXPECT_LE(said, now());
    EXPECT_LE(now(), said + slack());
    const State state = initial_state(*model, Precision::single);
    EXPECT_LE(now(), said + static_cast<std::int64_t>(state_bytes(count(*model))) + slack());
  }
}

TEST_F(Memory, OfACpuSolverIsWhatSceneCheckSays) {
  const BackendRow& row = *find_backend("cpu");
  for (ModelSettings settings : scenes()) {
    for (const Integrator integrator : all_integrators) {
      settings.simulation.integrator = integrator;
      const SharedModel model = shared(std::move(*build_model(settings)));
      const auto said = static_cast<std::int64_t>(row.bytes(*model, {&row}).value());
      SetUp();
      const auto made = make_backend({&row}, model);
      ASSERT_TRUE(made.ok());
      EXPECT_LE(said, now()) << name_of(integrator);
      EXPECT_LE(now(), said + slack()) << name_of(integrator);
      most_held = held.load();
      ASSERT_FALSE((*made->solver->advance(2)).divergence.has_value());
      EXPECT_LE(most(), said + slack() + said / 20) << name_of(integrator) << ": a step needs no more";
    }
  }
}

TEST_F(Memory, OfTheReferencesStepsIsWhatSceneCheckSays) {
  const BackendRow& row = reference_backend();
  for (ModelSettings settings : scenes()) {
    for (const Integrator integrator : all_integrators) {
      for (const Precision precision : row.precisions) {
        settings.simulation.integrator = integrator;
        const SharedModel model = shared(std::move(*build_model(settings)));
        const BackendChoice choice = {.row = &row, .precision = precision};
        const auto said = static_cast<std::int64_t>(row.bytes(*model, choice).value());
        SetUp();
        const auto made = make_backend(choice, model);
        ASSERT_TRUE(made.ok());
        most_held = held.load();
        ASSERT_FALSE((*made->solver->advance(2)).divergence.has_value());
        EXPECT_LE(most(), said + slack()) << name_of(integrator);
        // A method may do with a field less than its stages call for, and a solve with fewer.
        EXPECT_GE(most(), said * 3 / 4) << name_of(integrator);
      }
    }
  }
}

}  // namespace
}  // namespace aspic
