// Every offence the lint knows, one a line, each named at its end. What the lint must not mind stands between them.
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
  return 0.5 * m * v;  // offence: inexact-return
}

float signed_off(float m) {
  return -m;
}

float rooted(float m) {
  return sqrt(m);  // offence: inexact-return forbidden
}

uint counted(uint a, uint b) {
  return a * b + 1u;
}

float cast(uint a) {
  return uintBitsToFloat(a + 1u);
}

void give(out float result, float a) {
  result = a * a;  // offence: inexact-store
}

void main() {
  uint i = gl_GlobalInvocationID.x + 1u;
  float loose = 1.0;                 // offence: missing-precise
  vec3 looser;                       // offence: missing-precise
  precise vec3 tight = vec3(1.0);
  float one, two;                    // offence: missing-precise missing-precise
  const float fixed_value = 2.0;     // offence: missing-precise
  const precise float good = 2.0;
  for (float f = 1.0; f < 2.0;) {    // offence: missing-precise
    double inner = 1.0;              // offence: missing-precise
  }
  precise float a = inversesqrt(2.0);          // offence: forbidden
  a = length(tight);                           // offence: forbidden
  uint n = uint(items.length());
  a = dot(tight, tight);                       // offence: forbidden
  a = mix(a, good, good);                      // offence: forbidden
  a = fma(a, a, a);                            // offence: fma
  a = a + 0.0;                                 // offence: adds-zero
  a = 0.0 + a;                                 // offence: adds-zero
  a += 0.0;                                    // offence: adds-zero
  tight = tight + vec3(0.0);                   // offence: adds-zero
  a = a - 0.0e3;                               // offence: adds-zero
  a = (-0.0);
  a = a * -0.0;
  a = a + 0.25;
  a = max(a, 0.0);
  i = i + 0u;
  a = exact_div(a * good, good);               // offence: inexact-argument
  a = exact_div(exact_sqrt(a + 1.0), -good);   // offence: inexact-argument
  a = exact_div(items[i + 1u].mass, good);
  take(i + 1u, vec3(a * good));                // offence: inexact-argument
  items[i + 1u].mass = a;
  items[i].position.xyz = tight;
  items[i].position = vec4(tight * a, 1.0);    // offence: inexact-store
  items[i].mass = a + good;                    // offence: inexact-store
  items[i].flags = i * 2u;
  partial[i] = a * a;                          // offence: inexact-store
  partial[i] += a;                             // offence: inexact-store
  block[i] *= a;                               // offence: inexact-store
  block[i] = -a;
  a = a * a + good;
#define SHORTEN(x) normalize(x)                // offence: forbidden
}
