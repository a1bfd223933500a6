// Preloaded by the tests under sanitizers: libraries stay loaded to the end. The leak checker looks after
// programs have unloaded their OpenGL driver, and needs its name (lsan.supp); the thread sanitizer ends when
// a driver that it is to overlook (tsan.supp) is unloaded.
extern "C" int dlclose(void*) {
  return 0;
}
