// Light maps: what bodies cover, seen from the sun (0) and from straight above the ground (1), as in our images.
#define LIGHT_SUN 0
#define LIGHT_SKY 1
struct Light {
  mat3 turn;   // from the world to the light's view, whose z goes away from it
  vec4 center; // of the box around all bodies, in that view; w: half its width [m]
  float depth; // half of it [m]
};
uniform Light lights[2];

vec3 in_light(int light, vec3 world) {
  vec3 p = lights[light].turn * world - lights[light].center.xyz;
  return vec3(p.xy / lights[light].center.w, p.z);
}

vec4 light_texel(int light, float depth) {
  return vec4(1.0, depth, lights[light].depth + depth, lights[light].depth - depth);
}
