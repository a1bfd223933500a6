#include "gpu_solver/ball_passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "device/particles.h"

namespace aspic {
namespace {

using gl::Binding;
using gl::Buffer;
using gl::ReadBy;

/// By BallPasses::Kernel.
constexpr KernelRow ball_kernels[] = {{"compute/ball_fly.comp", "balls: flight and terrain"},
                                      {"compute/ball_clear.comp", "balls: empty grid and marks"},
                                      {"compute/ball_insert.comp", "balls: fill the grid"},
                                      {"compute/ball_find.comp", "balls: find contacts"},
                                      {"compute/ball_gather.comp", "balls: find blocks of particles"},
                                      {"compute/ball_near.comp", "balls: search blocks"},
                                      {"compute/ball_tally.comp", "balls: count contacts"},
                                      {"compute/ball_partials.comp", "balls: sum blocks"},
                                      {"compute/ball_exchange.comp", "balls: impulses on balls"},
                                      {"compute/ball_particles.comp", "balls: impulses on particles"},
                                      {"compute/ball_end.comp", "balls: end of the step"}};

/// Words of marks that all balls may have: 16 MiB.
constexpr std::uint64_t most_mark_words = std::uint64_t{1} << 22;

std::uint64_t blocks_of(std::uint64_t count) {
  return (count + PARTNER_BLOCK - 1) / PARTNER_BLOCK;
}

/// Words of one ball's marks, as mark_words() in ball_grid.glsl.
std::uint64_t mark_words(std::uint32_t particles, std::uint32_t shift) {
  const std::uint64_t marks = (blocks_of(particles) + (std::uint64_t{1} << shift) - 1) >> shift;
  return (marks + 31) / 32;
}

std::uint64_t grid_bytes(std::uint32_t balls, std::uint32_t particles) {
  return 4 * (std::uint64_t{grid_buckets(balls)} + balls +
              balls * mark_words(particles, mark_shift(balls, particles)));
}

/// Room at first: a heap's contacts, and a few blocks of particles for each ball.
std::uint64_t first_list_words(std::uint64_t balls) {
  return 4096 + 8 * balls;
}
std::uint64_t first_items(std::uint64_t balls) {
  return 64 + 4 * balls;
}

}  // namespace

std::uint32_t grid_buckets(std::uint32_t balls) {
  return std::bit_ceil(2 * std::max(balls, 32u));
}

bool grid_pays(std::uint32_t balls) {
  return balls > 64;
}

std::uint32_t mark_shift(std::uint32_t balls, std::uint32_t particles) {
  std::uint32_t shift = 0;
  while (shift < 24 && balls * mark_words(particles, shift) > most_mark_words) ++shift;
  return shift;
}

void fill_balls(layout::Simulation& block, const Model& model) {
  block.ball_count = model.ball_count();
  block.ball_spin = model.contact.spin ? 1u : 0u;
  block.ball_restitution = static_cast<float>(model.contact.ball_restitution);
  block.ball_friction = static_cast<float>(model.contact.ball_friction);
  block.bucket_mask = grid_buckets(model.ball_count()) - 1;
  block.mark_shift = mark_shift(model.ball_count(), model.particle_count());
  double radius = 0.0;
  for (const Ball& ball : model.balls) radius = std::max(radius, ball.radius);
  // A ball's reach to another, and twice its reach to a particle, and a quarter more, so that neighbors are
  // never two cells apart, or one and a half, rounding included.
  block.ball_cells_per_meter = static_cast<float>(1.0 / (2.5 * (radius + model.contact.distance)));
}

std::uint64_t ball_bytes(const ModelCounts& counts) {
  if (counts.balls == 0) return 0;
  const auto balls = static_cast<std::uint32_t>(counts.balls),
             particles = static_cast<std::uint32_t>(counts.particles);
  return counts.balls * (BALL_SLOTS * sizeof(layout::Ball) + sizeof(layout::BallBody)) +
         (counts.balls + counts.particles) * sizeof(layout::BallContacts) + grid_bytes(balls, particles) +
         sizeof(layout::BallWork) + 4 * first_list_words(counts.balls) +
         first_items(counts.balls) * sizeof(layout::BallItem);
}

std::vector<std::string> BallPasses::pass_names() {
  std::vector<std::string> titles = titles_of(ball_kernels);
  for (std::string& title : BallFacePasses::pass_names()) titles.push_back(std::move(title));
  return titles;
}

/// Which kernels the scene needs. Only with more than LIST_SIZE other balls can a body be crowded.
bool BallPasses::wanted(Kernel kernel) const {
  const bool crowds = count_ > LIST_SIZE, with_particles = particle_count_ > 0;
  switch (kernel) {
    case insert:
      return grid_;
    case gather:
    case tally:
    case particles:
      return with_particles;
    case near:
      return crowds || with_particles;
    case partials:
      return std::uint64_t{count_} + particle_count_ > PARTNER_BLOCK;
    case end_implicit:
      return implicit_;
    default:
      return true;
  }
}

Status BallPasses::build_buffers() {
  const std::uint64_t bodies = std::uint64_t{count_} + particle_count_;
  ASPIC_TRY(balls_,
            Buffer::create(*context_, "balls", BALL_SLOTS * std::uint64_t{count_} * sizeof(layout::Ball)));
  ASPIC_TRY(bodies_, Buffer::create(*context_, "ball constants", count_ * sizeof(layout::BallBody)));
  ASPIC_TRY(contacts_, Buffer::create(*context_, "ball contacts", bodies * sizeof(layout::BallContacts)));
  ASPIC_TRY(grid_words_, Buffer::create(*context_, "ball grid", grid_bytes(count_, particle_count_)));
  ASPIC_CHECK(allot(first_list_words(count_), first_items(count_)));
  first_bytes_ = work_.bytes() + items_.bytes();
  return {};
}

/// Gives the lists and the items this much room, where they have less. Their contents are lost.
Status BallPasses::allot(std::uint64_t list_words, std::uint64_t items) {
  if (list_words > list_capacity_) {
    ASPIC_TRY(work_,
              Buffer::create(*context_, "lists of ball contacts", sizeof(layout::BallWork) + 4 * list_words));
    list_capacity_ = list_words;
  }
  if (items > item_capacity_) {
    ASPIC_TRY(items_, Buffer::create(*context_, "blocks of ball contacts", items * sizeof(layout::BallItem)));
    item_capacity_ = items;
  }
  return {};
}

void BallPasses::reset_work() {
  layout::BallWork work{};
  work.list_capacity = static_cast<std::uint32_t>(list_capacity_);
  work.item_capacity = static_cast<std::uint32_t>(item_capacity_);
  work_.upload_items(std::span(&work, 1));
}

Status BallPasses::grow() {
  const layout::BallWork work = work_.download_items<layout::BallWork>(1).front();
  ASPIC_CHECK(context_->check());
  // A quarter more than was asked for, so that a crowd that grows is not in the way at every step; where
  // nothing more was asked for, the passes stopped half-way.
  const auto room = [](std::uint64_t held, std::uint64_t used) {
    return used > held ? used + used / 4 : held;
  };
  std::uint64_t list_words = room(list_capacity_, work.lists_used),
                items = room(item_capacity_, work.items_used);
  if (list_words == list_capacity_ && items == item_capacity_) {
    list_words *= 2;
    items *= 2;
  }
  if (const Status made = allot(list_words, items); !made) {
    return advised(fail(made.error(),
                        "The balls of the scene have more contacts than fit on the device {}: they need {} "
                        "words of lists and {} blocks of 256 candidates. {}",
                        context_->info().renderer, list_words, items, made.error().what),
                   {advice("start fewer balls in one place"), use_backend("cpu")});
  }
  reset_work();
  return {};
}

std::uint64_t BallPasses::grown_bytes() const {
  return any() ? work_.bytes() + items_.bytes() - first_bytes_ : 0;
}

Status BallPasses::build(gl::Context& context, const Model& model, const KernelOptions& kernels,
                         const Surroundings& surroundings, BallSearch search) {
  context_ = &context;
  model_ = &model;
  count_ = model.ball_count();
  particle_count_ = model.particle_count();
  if (!any()) return {};
  implicit_ = surroundings.implicit;
  grid_ = search == BallSearch::automatic ? grid_pays(count_) : search == BallSearch::grid;
  ASPIC_CHECK(build_buffers());

  KernelOptions own = kernels;
  if (implicit_) own.defines.push_back({"ASPIC_IMPLICIT", "1"});
  if (grid_) own.defines.push_back({"ASPIC_BALL_GRID", "1"});
  static_assert(BINDING_SOLVE == BINDING_CONTROL, "one place for either");
  ASPIC_CHECK(faces_.build(context, model, own,
                           {{BINDING_SIMULATION, surroundings.simulation, gl::BufferKind::uniform},
                            {BINDING_BALLS, &balls_},
                            {BINDING_CONTROL, surroundings.control}}));
  if (faces_.any()) own.defines.push_back({"ASPIC_BALL_FACES", "1"});
  for (std::size_t k = 0; k < kernel_count; ++k) {
    if (!wanted(static_cast<Kernel>(k))) continue;
    std::vector<Binding> bindings = {
        {BINDING_SIMULATION, surroundings.simulation, gl::BufferKind::uniform},
        surroundings.poses,
        {BINDING_BALLS, &balls_},
        k == fly ? Binding{BINDING_BALL_BODIES, &bodies_} : Binding{BINDING_BALL_ITEMS, &items_},
        {BINDING_BALL_CONTACTS, &contacts_},
        {BINDING_BALL_GRID, &grid_words_},
        {BINDING_BALL_WORK, &work_},
        {BINDING_CONTROL, surroundings.control}};
    if (k == fly) bindings.push_back(surroundings.pulls);
    ASPIC_TRY(programs_[k], own.start(ball_kernels[k].path));
    passes_[k].emplace(*programs_[k], bindings, ReadBy::compute_pass);
  }
  return {};
}

void BallPasses::load(const ConstStateView& state, std::uint64_t step) {
  if (!any()) return;
  const std::vector<layout::Ball> balls = packed_balls(*model_, state, step);
  balls_.upload_items(balls);
  reset_work();
  set_base_step(step);
}

void BallPasses::set_base_step(std::uint64_t base_step) {
  if (!any()) return;
  std::vector<layout::BallBody> bodies(count_);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Ball& ball = model_->balls[b];
    const std::uint64_t wait = ball.launch_step > base_step ? ball.launch_step - base_step : 0;
    bodies[b] = {static_cast<float>(ball.mass), static_cast<float>(1.0 / ball.mass),
                 static_cast<std::uint32_t>(std::min<std::uint64_t>(wait, 0xffffffffu)), 0};
  }
  bodies_.upload_items(bodies);
}

void BallPasses::dispatch(const Queue& queue, Kernel kernel, std::uint32_t items, ReadBy readers) const {
  if (!passes_[kernel] || items == 0) return;
  passes_[kernel]->dispatch_for(items, queue.states, readers);
  mark(kernel);
}

void BallPasses::dispatch_indirect(const Queue& queue, Kernel kernel, std::size_t arguments) const {
  if (!passes_[kernel]) return;
  passes_[kernel]->dispatch_indirect(work_, arguments, queue.states);
  mark(kernel);
}

/// Whom each body touches, all of it before anyone receives anything: where room is missing, the step can be
/// repeated.
void BallPasses::find_contacts(const Queue& queue) const {
  const ReadBy next = ReadBy::compute_pass, counted = ReadBy::compute_pass | ReadBy::indirect;
  const std::uint64_t marks = count_ * mark_words(particle_count_, mark_shift(count_, particle_count_));
  dispatch(queue, clear, static_cast<std::uint32_t>(grid_buckets(count_) + marks));
  dispatch(queue, insert, count_, next);
  dispatch(queue, find, count_ + particle_count_, counted);
  if (count_ > LIST_SIZE) {
    programs_[near]->set(LOCATION_BALL_KIND, std::uint32_t{KIND_BALL});
    dispatch_indirect(queue, near, offsetof(layout::BallWork, word_groups));
  }
  if (particle_count_ > 0) {
    dispatch(queue, gather, count_, counted);
    programs_[near]->set(LOCATION_BALL_KIND, std::uint32_t{KIND_PARTICLE});
    dispatch_indirect(queue, near, offsetof(layout::BallWork, word_groups));
  }
}

void BallPasses::queue_phase(const Queue& queue, std::uint32_t phase) const {
  for (const Kernel kernel : {partials, exchange, particles}) {
    if (programs_[kernel]) programs_[kernel]->set(LOCATION_BALL_PHASE, phase);
  }
  const bool ends = phase + 1 == BALL_PHASES && !implicit_ && !faces_.any();
  const ReadBy after = ends ? queue.last : ReadBy(ReadBy::compute_pass);
  if (phase == BALL_PHASE_PARTICLES) {
    dispatch_indirect(queue, tally, offsetof(layout::BallWork, tally_groups));
  }
  // Fewer balls make no sum of more than one block among themselves.
  if (phase != BALL_PHASE_BALLS || count_ > PARTNER_BLOCK) {
    dispatch_indirect(queue, partials, offsetof(layout::BallWork, item_groups));
  }
  dispatch(queue, exchange, count_, after);
  if (phase != BALL_PHASE_BALLS) dispatch(queue, particles, particle_count_, after);
}

void BallPasses::queue(const Buffer& start, const Buffer& end, std::uint32_t step, std::uint32_t parity,
                       ReadBy last) const {
  if (!any()) return;
  const std::array<Binding, 2> states = {{{BINDING_STATE_A, &start}, {BINDING_STATE_B, &end}}};
  const Queue queue = {states, last};
  if (!implicit_) {
    for (const auto& program : programs_) {
      if (!program) continue;
      program->set(LOCATION_STEP, step);
      program->set(LOCATION_BALL_PARITY, parity);
    }
    faces_.begin_step(step, parity);
  }
  dispatch(queue, fly, count_);
  find_contacts(queue);
  faces_.queue_find(queue.states);
  for (std::uint32_t phase = 0; phase < BALL_PHASES; ++phase) queue_phase(queue, phase);
  faces_.queue_meet(queue.states, implicit_ ? ReadBy(ReadBy::compute_pass) : last);
  if (implicit_) dispatch(queue, end_implicit, 1, last);
}

void BallPasses::read(const StateView& view, std::uint32_t slot) const {
  if (!any()) return;
  unpack(balls_.download_items<layout::Ball>(count_, std::uint64_t{slot} * count_), view);
}

}  // namespace aspic
