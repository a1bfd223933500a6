// Shared by the kernels of balls and faces (docs/balls.md, "Faces"): src/physics/balls/faces.h in GLSL. Of each ball and
// body with faces there is a pair, which names the nearest face if the ball touches it.
layout(std430, binding = BINDING_BALL_FACES) restrict readonly buffer FacesBlock { uvec4 faces[]; };
layout(std430, binding = BINDING_BALL_FACE_BOXES) restrict buffer FaceBoxes { vec4 face_boxes[]; };
layout(std430, binding = BINDING_BALL_FACE_PAIRS) restrict buffer FacePairs { BallFacePair face_pairs[]; };
layout(std430, binding = BINDING_BALL_FACE_COUNTS) restrict buffer FaceCounts { BallFaceCount face_counts[]; };

uint face_body_count() { return faces[0].x; }
uint face_block_count() { return faces[0].y; }
uint pair_count() { return ball_count * face_body_count(); }
uint body_of_pair(uint pair) { return pair % face_body_count(); }
uint ball_of_pair(uint pair) { return pair / face_body_count(); }
uvec4 row_of_faces(uint body) { return faces[1u + body]; }
uvec3 corners_of(uint t) { return faces[1u + face_body_count() + t].xyz; }

vec3 end_place(uint p) { return end_particle(p).position.xyz; }

bool box_beyond(vec3 low, vec3 high, float far, vec3 P) {
  precise vec3 below = low - P, above = P - high;
  precise vec3 away = max(max(below, above), vec3(0.0));
  precise float limit = far * far;
  return dot3(away, away) > limit;
}

// Σ share·y over the corners.
vec3 over_shares(BallFacePair pair, vec3 y_0, vec3 y_1, vec3 y_2) {
  precise vec3 sum = (pair.share[0] * y_0 + pair.share[1] * y_1) + pair.share[2] * y_2;
  return sum;
}

vec3 end_velocity(uint p) { return end_particle(p).velocity.xyz; }
vec3 start_velocity(uint p) { return start_particle(p).velocity.xyz; }
