// The third line names what does not exist.
void part() {
  precise float x = misspelt;
}
