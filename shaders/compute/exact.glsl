float exact_div(float a, float b) {
  precise float q = a / b;
  return q;
}
float exact_sqrt(float x) {
  precise float s = sqrt(x);
  return s;
}
