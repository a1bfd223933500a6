// How far a point lies on the side of the cut that is drawn [m]; 1 where nothing is cut.
float kept(vec3 position) { return cut.w - dot(cut.xyz, position); }

// Ends a segment at the cut; false if all of it is cut away.
bool cut_segment(inout vec3 a, inout vec3 b) {
  float of_a = kept(a);
  float of_b = kept(b);
  if (of_a < 0.0 && of_b < 0.0) return false;
  if (of_a < 0.0) a = mix(b, a, of_b / (of_b - of_a));
  if (of_b < 0.0) b = mix(a, b, of_a / (of_a - of_b));
  return true;
}
