// Every offense the lint knows, one a line, each named at its end. What the lint must not mind stands between them.
struct Item {
  vec4 position;
  float mass;
  uint flags;
};
layout(std430, binding = 0) buffer Items {
  Item items[];
};
layout(std430, binding = 1) buffer Sums {
  float partial[];
};
shared float block[256];
const float third = 0.25;

float plain(float a, float b) {
  return a;
}

float kinetic(float m, float v) {
  precise float half_m = 0.5 * m, square = v * v;
  precise float energy = half_m * square;
  /* float inside = a comment;
     normalize(too) */
  return energy;
}

float hurried(float m, float v) {
  return 0.5 * m * v;  // offense: inexact-return
}

float signed_off(float m) {
  return -m;
}

float rooted(float m) {
  return sqrt(m);  // offense: inexact-return forbidden
}

uint counted(uint a, uint b) {
  return a * b + 1u;
}

float cast(uint a) {
  return uintBitsToFloat(a + 1u);
}

void give(out float result, float a) {
  result = a * a;  // offense: inexact-store
}

void main() {
  uint i = gl_GlobalInvocationID.x + 1u;
  float loose = 1.0;                 // offense: missing-precise
  vec3 looser;                       // offense: missing-precise
  precise vec3 tight = vec3(1.0);
  float one, two;                    // offense: missing-precise missing-precise
  const float fixed_value = 2.0;     // offense: missing-precise
  const precise float good = 2.0;
  for (float f = 1.0; f < 2.0;) {    // offense: missing-precise
    double inner = 1.0;              // offense: missing-precise
  }
  precise float a = inversesqrt(2.0);          // offense: forbidden
  a = length(tight);                           // offense: forbidden
  uint n = uint(items.length());
  a = dot(tight, tight);                       // offense: forbidden
  a = mix(a, good, good);                      // offense: forbidden
  a = fma(a, a, a);                            // offense: fma
  a = a + 0.0;                                 // offense: adds-zero
  a = 0.0 + a;                                 // offense: adds-zero
  a += 0.0;                                    // offense: adds-zero
  tight = tight + vec3(0.0);                   // offense: adds-zero
  a = a - 0.0e3;                               // offense: adds-zero
  a = (-0.0);
  a = a * -0.0;
  a = a + 0.25;
  a = max(a, 0.0);
  i = i + 0u;
  a = exact_div(a * good, good);               // offense: inexact-argument
  a = exact_div(exact_sqrt(a + 1.0), -good);   // offense: inexact-argument
  a = exact_div(items[i + 1u].mass, good);
  take(i + 1u, vec3(a * good));                // offense: inexact-argument
  items[i + 1u].mass = a;
  items[i].position.xyz = tight;
  items[i].position = vec4(tight * a, 1.0);    // offense: inexact-store
  items[i].mass = a + good;                    // offense: inexact-store
  items[i].flags = i * 2u;
  partial[i] = a * a;                          // offense: inexact-store
  partial[i] += a;                             // offense: inexact-store
  block[i] *= a;                               // offense: inexact-store
  block[i] = -a;
  a = a * a + good;
#define SHORTEN(x) normalize(x)                // offense: forbidden
}
