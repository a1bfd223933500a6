// So many rounds, or MAX_ROUNDS if they are more, which is reported. Expects report_overrun.
uint bounded(uint rounds, uint kernel) {
  if (rounds <= MAX_ROUNDS) return rounds;
  report_overrun(kernel);
  return MAX_ROUNDS;
}
