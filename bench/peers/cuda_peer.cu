// The lattice in CUDA as Warp's integrators do it: a kernel over the list of springs adds to the forces of both ends
// with float atomics, a kernel over the particles moves them. Explicit Euler, single precision. Built by the GPU kit
// where nvcc is; the conversation is that of README.md, without libraries. With --host the same code runs on the
// processor, one thread, so that it can be checked where no card is.
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <iostream>
#include <string>
#include <vector>

#include "lattice.h"

#ifdef __CUDACC__
#include <cuda_runtime.h>
#define ANYWHERE __host__ __device__
#else
#define ANYWHERE
#endif

namespace {

struct Vector {
  float x = 0, y = 0, z = 0;
};
struct Ends {
  int a, b;
};

/// What both kernels work on.
struct Cube {
  int particles = 0, springs = 0;
  float k = 0, c = 0, h = 0, gravity = 0, inverse_mass = 0;
  Vector *x = nullptr, *v = nullptr, *f = nullptr, *start = nullptr;
  Ends* ends = nullptr;
  float* lengths = nullptr;
};

ANYWHERE inline void add(float* to, float value) {
#ifdef __CUDA_ARCH__
  atomicAdd(to, value);
#else
  *to += value;
#endif
}

ANYWHERE inline float root(float square) {
#ifdef __CUDA_ARCH__
  return sqrtf(square);
#else
  return std::sqrt(square);
#endif
}

ANYWHERE inline void add_spring(const Cube& cube, int s) {
  const Ends ends = cube.ends[s];
  const Vector xa = cube.x[ends.a], xb = cube.x[ends.b], va = cube.v[ends.a], vb = cube.v[ends.b];
  const float ex = xa.x - xb.x, ey = xa.y - xb.y, ez = xa.z - xb.z;
  const float length = root(ex * ex + ey * ey + ez * ez);
  const float dx = ex / length, dy = ey / length, dz = ez / length;
  const float along = (va.x - vb.x) * dx + (va.y - vb.y) * dy + (va.z - vb.z) * dz;
  const float force = cube.k * (length - cube.lengths[s]) + cube.c * along;
  Vector &fa = cube.f[ends.a], &fb = cube.f[ends.b];
  add(&fa.x, -force * dx);
  add(&fa.y, -force * dy);
  add(&fa.z, -force * dz);
  add(&fb.x, force * dx);
  add(&fb.y, force * dy);
  add(&fb.z, force * dz);
}

ANYWHERE inline void move_particle(const Cube& cube, int i) {
  Vector &x = cube.x[i], &v = cube.v[i], &f = cube.f[i];
  x = {x.x + cube.h * v.x, x.y + cube.h * v.y, x.z + cube.h * v.z};
  v = {v.x + cube.h * (cube.inverse_mass * f.x), v.y + cube.h * (cube.inverse_mass * f.y - cube.gravity),
       v.z + cube.h * (cube.inverse_mass * f.z)};
  f = {};
}

#ifdef __CUDACC__
__global__ void add_springs(Cube cube) {
  const int s = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (s < cube.springs) add_spring(cube, s);
}

__global__ void move_particles(Cube cube) {
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < cube.particles) move_particle(cube, i);
}

void require(cudaError_t done) {
  if (done == cudaSuccess) return;
  std::fprintf(stderr, "CUDA: %s\n", cudaGetErrorString(done));
  std::exit(1);
}
#endif

class Peer {
 public:
  Peer(const peer::Lattice& lattice, bool host) : host_(host) {
    std::vector<Vector> start;
    std::vector<Ends> ends;
    std::vector<float> lengths;
    lattice.for_each_particle(lattice.stretch, [&](double x, double y, double z) {
      start.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    });
    lattice.for_each_spring([&](int a, int b, double length) {
      ends.push_back({a, b});
      lengths.push_back(static_cast<float>(length));
    });
    cube_.particles = static_cast<int>(start.size());
    cube_.springs = static_cast<int>(ends.size());
    cube_.k = static_cast<float>(lattice.stiffness);
    cube_.c = static_cast<float>(lattice.damping);
    cube_.h = static_cast<float>(lattice.timestep);
    cube_.gravity = static_cast<float>(lattice.gravity);
    cube_.inverse_mass = static_cast<float>(1.0 / lattice.mass);
    cube_.start = copied(start);
    cube_.ends = copied(ends);
    cube_.lengths = copied(lengths);
    cube_.x = copied(start);
    cube_.v = copied(std::vector<Vector>(start.size()));
    cube_.f = copied(std::vector<Vector>(start.size()));
  }

  int springs() const { return cube_.springs; }

  void load() {
    const std::vector<Vector> zero(static_cast<std::size_t>(cube_.particles));
    const std::vector<Vector> start = read(cube_.start);
    write(cube_.x, start);
    write(cube_.v, zero);
    write(cube_.f, zero);
  }

  void advance(long steps) {
    for (long n = 0; n < steps; ++n) step();
#ifdef __CUDACC__
    if (!host_) require(cudaDeviceSynchronize());
#endif
  }

  std::vector<Vector> positions() const { return read(cube_.x); }

 private:
  void step() {
#ifdef __CUDACC__
    if (!host_) {
      constexpr int threads = 256;
      add_springs<<<(cube_.springs + threads - 1) / threads, threads>>>(cube_);
      move_particles<<<(cube_.particles + threads - 1) / threads, threads>>>(cube_);
      return;
    }
#endif
    for (int s = 0; s < cube_.springs; ++s) add_spring(cube_, s);
    for (int i = 0; i < cube_.particles; ++i) move_particle(cube_, i);
  }

  /// Memory for as long as the process lives.
  template <class T>
  T* copied(const std::vector<T>& items) const {
    T* memory = nullptr;
#ifdef __CUDACC__
    if (!host_) {
      require(cudaMalloc(&memory, items.size() * sizeof(T)));
      write(memory, items);
      return memory;
    }
#endif
    memory = new T[items.size()];
    write(memory, items);
    return memory;
  }

  template <class T>
  void write(T* memory, const std::vector<T>& items) const {
#ifdef __CUDACC__
    if (!host_) return require(cudaMemcpy(memory, items.data(), items.size() * sizeof(T), cudaMemcpyHostToDevice));
#endif
    std::memcpy(memory, items.data(), items.size() * sizeof(T));
  }

  std::vector<Vector> read(const Vector* memory) const {
    std::vector<Vector> items(static_cast<std::size_t>(cube_.particles));
#ifdef __CUDACC__
    if (!host_) {
      require(cudaMemcpy(items.data(), memory, items.size() * sizeof(Vector), cudaMemcpyDeviceToHost));
      return items;
    }
#endif
    std::memcpy(items.data(), memory, items.size() * sizeof(Vector));
    return items;
  }

  Cube cube_;
  bool host_;
};

}  // namespace

int main(int argc, char** argv) {
  peer::Lattice lattice;
#ifdef __CUDACC__
  bool host = false;
  std::string device = "host";
#else
  bool host = true;
  const std::string device = "host";
#endif
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--host") {
      host = true;
      continue;
    }
    if (i + 1 == argc) break;
    const double value = std::atof(argv[++i]);
    if (name == "--size") lattice.n = static_cast<int>(value);
    if (name == "--edge") lattice.edge = value;
    if (name == "--height") lattice.height = value;
    if (name == "--mass") lattice.mass = value;
    if (name == "--stiffness") lattice.stiffness = value;
    if (name == "--damping") lattice.damping = value;
    if (name == "--timestep") lattice.timestep = value;
    if (name == "--gravity") lattice.gravity = value;
    if (name == "--stretch") lattice.stretch = value;
  }
#ifdef __CUDACC__
  if (!host) {
    cudaDeviceProp card;
    require(cudaGetDeviceProperties(&card, 0));
    device = card.name;
  }
#endif
  Peer peer(lattice, host);
  std::printf("{\"name\": \"cuda\", \"version\": \"%s\", \"threads\": 1, \"integrator\": \"explicit-euler\", "
              "\"damping\": %.17g, \"deviation\": 0.0, \"springs\": %d}\n",
              device.c_str(), lattice.damping, peer.springs());
  std::fflush(stdout);
  std::string word;
  for (long steps = 0; std::cin >> word >> steps;) {
    peer.load();
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor_start = std::clock();
    peer.advance(steps);
    const double processor_seconds = static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    const std::vector<Vector> x = peer.positions();
    double sum = 0.0;
    for (const Vector& at : x) sum += at.y;
    std::printf("{\"seconds\": %.9g, \"processor_seconds\": %.9g, \"height\": %.17g", took.count(), processor_seconds,
                sum / static_cast<double>(x.size()));
    if (word == "positions") {
      std::printf(", \"positions\": [");
      for (std::size_t i = 0; i < x.size(); ++i)
        std::printf("%s%.9g, %.9g, %.9g", i == 0 ? "" : ", ", x[i].x, x[i].y, x[i].z);
      std::printf("]");
    }
    std::printf("}\n");
    std::fflush(stdout);
  }
  return 0;
}
