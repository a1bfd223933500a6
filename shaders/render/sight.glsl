// ClosestPoint lines: from the eye, or all parallel in an orthographic image, whose eye is far away.

// Unit, from a point of the world towards the eye.
vec3 to_eye(vec3 position) { return normalize(viewer.xyz - viewer.w * position); }

// From the eye to a point of the world; in an orthographic image along the view alone.
vec3 way_from_eye(vec3 position) {
  vec3 way = position - eye.xyz;
  return viewer.w > 0.0 ? way : dot(way, viewer.xyz) * viewer.xyz;
}

// In the eye's space, unit, the direction in which a point is seen.
vec3 sight_of(vec3 in_view) { return normalize(vec3(viewer.w * in_view.xy, in_view.z)); }

// Size of a pixel at a distance along the view [m].
float pixel_at(float distance) { return (viewer.w > 0.0 ? distance : 1.0) * 2.0 / (projection[1][1] * viewport.y); }
