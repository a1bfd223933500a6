#pragma once
// What owns a GL object.
#include <cstdint>
#include <utility>

namespace aspic::gl {

/// A GL name and how to delete it. Movable, not copyable; its context must outlive it and be current.
class Name {
 public:
  using Delete = void (*)(std::uint32_t id);

  /// No object: id 0.
  Name() = default;
  Name(std::uint32_t id, Delete deletion) : id_(id), delete_(deletion) {}
  ~Name() {
    if (id_ != 0) delete_(id_);
  }
  Name(Name&& other) noexcept : id_(std::exchange(other.id_, 0)), delete_(other.delete_) {}
  Name& operator=(Name&& other) noexcept {
    Name taken(std::move(other));
    std::swap(id_, taken.id_);
    std::swap(delete_, taken.delete_);
    return *this;
  }

  std::uint32_t id() const { return id_; }

 private:
  std::uint32_t id_ = 0;
  Delete delete_ = nullptr;
};

}  // namespace aspic::gl
