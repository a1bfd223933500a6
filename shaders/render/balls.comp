// Turns every ball by its angular velocity since the image before, and adds the balls to the box of each light.
#include "render/layout.glsl"
#include "render/bounds.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_BALLS) restrict readonly buffer Balls { Ball balls[]; };
layout(std430, binding = BINDING_TURNS) restrict buffer Turns { vec4 turns[]; };
layout(location = LOCATION_COUNT) uniform uint ball_count;
layout(location = LOCATION_FIRST) uniform uint first_ball;
layout(location = LOCATION_ELAPSED) uniform float elapsed;

// How many times as far as its target the eye looks: balls beyond are left out where one could spoil the image of all.
const float far_share = 3.0;

void main() {
  uint i = item_index();
  if (i >= ball_count) return;
  Ball ball = balls[first_ball + i];
  if (ball.velocity.w == 0.0) return;

  float rate = length(ball.spin.xyz);
  if (rate * elapsed > 0.0) {
    vec3 axis = sin(0.5 * rate * elapsed) * ball.spin.xyz / rate;
    float cosine = cos(0.5 * rate * elapsed);
    vec4 q = turns[i];
    turns[i] = normalize(vec4(cosine * q.xyz + q.w * axis + cross(axis, q.xyz), cosine * q.w - dot(axis, q.xyz)));
  }

  // One ball that flies off must not take the maps' texels from the others.
  vec3 camera = eye.xyz - (viewer.w > 0.0 ? 0.0 : (ORTHOGRAPHIC_DISTANCE - 1.0) * eye.w) * viewer.xyz;
  if (distance(ball.position.xyz, camera) > far_share * eye.w) return;
  for (int light = 0; light < LIGHTS; ++light) {
    vec3 p = mat3(lights[light]) * ball.position.xyz;
    widen(light, ordered(p - ball.position.w), ordered(p + ball.position.w));
  }
}
