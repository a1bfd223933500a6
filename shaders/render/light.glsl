// Light maps: the area that bodies cover, seen from a light. x: covered 0…1. The sun's, of the surfaces nearest to it:
// y: covered times depth from the box's center [m]. The sky's, of all: z: covered times how deep the lowest lies below the
// box's upper side; w: how high the highest lies above its lower side [m].
layout(std140, binding = BINDING_LIGHT_BOXES) uniform LightBoxes { LightBox light_boxes[LIGHTS]; };

// Position in a light's map: xy −1…1, z: depth from the center [m].
vec3 in_light(int light, vec3 world) {
  vec3 p = mat3(lights[light]) * world - light_boxes[light].center.xyz;
  return vec3(p.xy * light_boxes[light].depth.y, p.z);
}

// The texel of a map for a body at this depth from the box's center that reaches so far above and below it [m].
vec4 light_texel(int light, float depth, float reach) {
  float half_depth = light_boxes[light].depth.x;
  return vec4(1.0, depth, half_depth + depth + reach, half_depth - depth + reach);
}
