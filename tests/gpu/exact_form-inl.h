// No guard: exact_forms.cpp includes this once for each set of defines, with ASPIC_FORM naming it.
namespace ASPIC_FORM {

#include "compute/exact.glsl"

// As the spring law takes it.
float reciprocal(float b) {
#ifdef ASPIC_QUICK
  if (in_middle(size_of(b))) return middle_rcp(b);
#endif
  return exact_div(1.0f, b);
}

WrongForms count_wrong(std::uint32_t stride) {
  WrongForms wrong;
  for (std::uint32_t n = 0; n < 1u << 23; n += stride) {
    const float b = uintBitsToFloat(0x3f800000u + n);
    wrong.reciprocals += floatBitsToUint(reciprocal(b)) != floatBitsToUint(1.0f / b);
  }
  for (std::uint32_t n = 0; n < 1u << 24; n += stride) {
    const float x = uintBitsToFloat(0x3f800000u + n);
    const float L = std::sqrt(x);
    const vec2 both = exact_sqrt_rcp(x);
    wrong.roots += floatBitsToUint(both.x) != floatBitsToUint(L);
    wrong.reciprocals_of_roots += floatBitsToUint(both.y) != floatBitsToUint(1.0f / L);
  }
  return wrong;
}

constexpr ExactForm form = {ASPIC_FORM_NAME, exact_div, reciprocal, exact_sqrt, count_wrong};

}  // namespace ASPIC_FORM
