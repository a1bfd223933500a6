#include "base/result.h"

#include <cstdio>
#include <cstdlib>

namespace aspic {

void end_at_wrong_access(const Error* error) noexcept {
  std::fprintf(stderr, "aspic: %s%s\n",
               error ? "the value of a Result was read that holds an error: "
                     : "the error of a Result was read that holds a value",
               error ? error->message().c_str() : "");
  std::abort();
}

}  // namespace aspic
