// line 1 of inner
// line 2 of inner