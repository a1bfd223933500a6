#pragma once
// What libaspic shows of itself: everything else is hidden in the shared library.
#if defined(_WIN32)
#define ASPIC_API
#else
#define ASPIC_API __attribute__((visibility("default")))
#endif
