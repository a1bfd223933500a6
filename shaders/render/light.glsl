// Light maps: the area that bodies cover, seen from a light. x: covered 0…1; y: covered times depth from the box's centre [m].
layout(std140, binding = BINDING_LIGHT_BOXES) uniform LightBoxes { LightBox light_boxes[LIGHTS]; };

// Position in a light's map: xy −1…1, z: depth from the centre [m].
vec3 in_light(int light, vec3 world) {
  vec3 p = mat3(lights[light]) * world - light_boxes[light].centre.xyz;
  return vec3(p.xy * light_boxes[light].depth.y, p.z);
}
