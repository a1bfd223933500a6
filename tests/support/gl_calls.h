#pragma once
// What a test's GL calls had the driver compile and wait for.
#include <glad/gl.h>

#include <algorithm>
#include <string>
#include <vector>

namespace aspic::testing {

/// Listens to the calls that make programs, from any context of this thread, for as long as it lives. One at
/// a time; contexts made meanwhile are not heard.
class GlCalls {
 public:
  GlCalls() {
    current_ = this;
    glad_glShaderSource = [](GLuint shader, GLsizei count, const GLchar* const* text, const GLint* length) {
      current_->sources.emplace_back(text[0], static_cast<std::size_t>(length[0]));
      current_->source_(shader, count, text, length);
    };
    glad_glLinkProgram = [](GLuint program) {
      current_->order += 'L';
      current_->link_(program);
    };
    glad_glGetShaderiv = [](GLuint shader, GLenum name, GLint* value) {
      current_->order += '?';
      current_->shader_(shader, name, value);
    };
    glad_glGetProgramiv = [](GLuint program, GLenum name, GLint* value) {
      if (name == GL_LINK_STATUS) current_->order += '?';
      current_->program_(program, name, value);
    };
    glad_glProgramBinary = [](GLuint program, GLenum format, const void* binary, GLsizei length) {
      current_->order += 'B';
      current_->binary_(program, format, binary, length);
    };
  }
  ~GlCalls() {
    glad_glShaderSource = source_;
    glad_glLinkProgram = link_;
    glad_glGetShaderiv = shader_;
    glad_glGetProgramiv = program_;
    glad_glProgramBinary = binary_;
  }
  GlCalls(const GlCalls&) = delete;
  GlCalls& operator=(const GlCalls&) = delete;

  /// Programs that were linked.
  std::ptrdiff_t links() const { return std::ranges::count(order, 'L'); }
  std::size_t lines() const {
    std::ptrdiff_t sum = 0;
    for (const std::string& text : sources) sum += std::ranges::count(text, '\n');
    return static_cast<std::size_t>(sum);
  }

  std::string order;  ///< L: a program is linked, B: given as a binary, ?: the result asked for
  std::vector<std::string> sources;  ///< of shaders

 private:
  static inline GlCalls* current_ = nullptr;
  decltype(glad_glShaderSource) source_ = glad_glShaderSource;
  decltype(glad_glLinkProgram) link_ = glad_glLinkProgram;
  decltype(glad_glGetShaderiv) shader_ = glad_glGetShaderiv;
  decltype(glad_glGetProgramiv) program_ = glad_glGetProgramiv;
  decltype(glad_glProgramBinary) binary_ = glad_glProgramBinary;
};

}  // namespace aspic::testing
