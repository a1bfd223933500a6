// Words of the ID image: what is there (kind and index), and how far along the view [m] as a float's bits. 0: nothing.
uint pick_word(uint kind, uint index) { return kind << PICK_KIND_SHIFT | index; }

// Depth of a point in the eye's space.
float depth_of(vec3 in_view) {
  vec4 clip = projection * vec4(in_view, 1.0);
  return clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 1.0);
}
