#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
layout(location = ATTRIBUTE_VELOCITY) in vec4 velocity;
layout(location = ATTRIBUTE_QUANTITY) in float quantity;
out vec3 end_velocity;
out float end_quantity;

void main() {
  end_velocity = velocity.xyz;
  end_quantity = quantity;
  gl_Position = vec4(position.xyz, 1.0);
}
