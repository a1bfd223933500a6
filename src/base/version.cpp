#include "aspic/version.h"

namespace aspic {

std::string_view library_version() {
  return ASPIC_VERSION;
}

}  // namespace aspic
