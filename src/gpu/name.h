#pragma once
// What owns a GL object.
#include <cstdint>
#include <utility>

#include "gpu/context.h"

namespace aspic::gl {

/// A GL name and how to delete it. Movable, not copyable; its context must outlive it, and need not be
/// current at its end.
class Name {
 public:
  /// No object: id 0.
  Name() = default;
  Name(Context& context, std::uint32_t id, Context::Delete deletion)
      : context_(&context), id_(id), delete_(deletion) {}
  ~Name() {
    if (id_ != 0) context_->dispose(id_, delete_);
  }
  Name(Name&& other) noexcept
      : context_(other.context_), id_(std::exchange(other.id_, 0)), delete_(other.delete_) {}
  Name& operator=(Name&& other) noexcept {
    Name taken(std::move(other));
    std::swap(context_, taken.context_);
    std::swap(id_, taken.id_);
    std::swap(delete_, taken.delete_);
    return *this;
  }

  std::uint32_t id() const { return id_; }

 private:
  Context* context_ = nullptr;
  std::uint32_t id_ = 0;
  Context::Delete delete_ = nullptr;
};

}  // namespace aspic::gl
