// No guard: exact_forms.cpp includes this with and without the processor's fma, which ASPIC_FMA is.
#define ASPIC_CORRECT_DIV
#define ASPIC_CORRECT_SQRT
#define ASPIC_FUSED_FMA

#define ASPIC_FORM slow
#define ASPIC_FORM_NAME "slow"
#include "gpu/exact_form-inl.h"
#undef ASPIC_FORM
#undef ASPIC_FORM_NAME

#define ASPIC_QUICK 1
#define ASPIC_FORM one_step
#define ASPIC_FORM_NAME "quick, one step"
#include "gpu/exact_form-inl.h"
#undef ASPIC_QUICK
#undef ASPIC_FORM
#undef ASPIC_FORM_NAME

#define ASPIC_QUICK 2
#define ASPIC_FORM two_steps
#define ASPIC_FORM_NAME "quick, two steps"
#include "gpu/exact_form-inl.h"
#undef ASPIC_QUICK
#undef ASPIC_FORM
#undef ASPIC_FORM_NAME

constexpr ExactForm forms[] = {slow::form, one_step::form, two_steps::form};

#undef ASPIC_CORRECT_DIV
#undef ASPIC_CORRECT_SQRT
#undef ASPIC_FUSED_FMA
