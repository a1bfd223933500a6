#pragma once
// What --help prints below the options of the program and of each command. A test runs the examples.

namespace aspic {

inline constexpr const char* main_examples = R"(Examples:
  aspic run cube-plane                              simulate a built-in scene, print a summary
  aspic run my-scene.toml --duration 2 --state end.csv --series energy.csv --every 10
  aspic run cube-plane --set simulation.timestep=0.002 --set "cube[0].shear.stiffness=10"
  aspic view cube-bowl                              open the window; F1 lists all keys
  aspic compare cube-plane --backends gpu,reference --steps 1000
  aspic verify --quick                              check this build on this machine
  aspic sweep cube-plane --vary k=500:8000:9:log --out k.csv   a run and a row per stiffness
  aspic report cube-plane --out report              compare integrators and parameters on a page
  aspic scene check my-scene.toml                   counts, memory and stable time steps
  aspic info                                        devices and limits

SCENE is a TOML file or the name of a built-in scene (aspic scene list).
Exit codes: 0 ok, 1 comparison or verification failed, 2 usage, 3 scene rejected, 4 no usable
GL device, 5 diverged, 6 input, output or memory failed, 130 interrupted, 141 stdout closed.)";

inline constexpr const char* scene_examples = R"(Examples:
  aspic scene list
  aspic scene show cube-plane > my-scene.toml
  aspic scene check my-scene.toml
  aspic scene import Configuration.txt > net.toml)";

inline constexpr const char* scene_list_examples = R"(Example:
  aspic scene list)";

inline constexpr const char* scene_show_examples = R"(Examples:
  aspic scene show cube-plane > my-scene.toml
  aspic scene show cube-plane --set simulation.integrator=midpoint)";

inline constexpr const char* scene_check_examples = R"(Examples:
  aspic scene check cube-bowl
  aspic scene check my-scene.toml --set simulation.timestep=0.002 --json

Exit code 3 if the scene is rejected; the report lists every error.)";

inline constexpr const char* scene_import_examples = R"(Examples:
  aspic scene import bunny.obj --cells 32 > bunny.toml
  aspic scene import part.stl --up z --height 0.2 > part.toml
  aspic scene import Configuration.txt > net.toml

Reports mesh repairs on stderr (docs/meshes.md). Settings that cannot be translated become comments in the scene.)";

inline constexpr const char* info_examples = R"(Examples:
  aspic info
  ASPIC_EGL_DEVICE=software aspic info              use another listed device)";

inline constexpr const char* run_examples = R"(Examples:
  aspic run cube-plane --steps 1000 --json
  aspic run cube-sphere --backend reference --precision double --state end.csv
  aspic run cube-bowl --video bowl.mp4 --speed 0.5 --view color=strain
  aspic run cube-plane --variant integrator=implicit-euler --variant h=0.002 --video variants.mp4
  aspic run cube-plane --html run.html --view color=strain
  aspic run cube-plane --export run.pvd --export-every 40
  aspic run cube-plane --frames out --fps 30 --size 640x360 --no-text
  aspic run cube-plane --duration 2 --checkpoint half.aspic
  aspic run --resume half.aspic --duration 4 --state end.csv
  aspic run cube-plane --replay hands.toml          pulls and pins by step, see docs/files.md)";

inline constexpr const char* view_examples = R"(Examples:
  aspic view                                        the first built-in scene; F1 lists all keys
  aspic view cube-sphere --backend gpu
  aspic view my-scene.toml --set simulation.timestep=0.002 --size 1600x900

Left drag turns the camera, right or Shift drag moves it, the wheel zooms; Space starts and pauses, G switches
to the next backend, Tab hides the panels.)";

inline constexpr const char* compare_examples = R"(Examples:
  aspic compare cube-plane --steps 1000
  aspic compare cube-bowl --backends gpu:gather,gpu:per-spring --steps 500
  aspic compare cube-plane --backends reference,reference:double --steps 100 --tolerance 1e-4)";

inline constexpr const char* bench_examples = R"(Examples:
  aspic bench --backend cpu,reference,gpu:gather,gpu:per-spring --size 10,20
  aspic bench large-cube --seconds 10 --json
  aspic bench --integrator explicit-euler --integrator implicit-euler --timestep largest --duration 1

--backend, --force-path, --size and --integrator take lists and can be repeated; Aspic measures every
combination. Each case runs --repeats times over the same steps from the scene's start, the cases of a size in turn. The
result is the median, the spread (slowest - fastest) / median. Spring evaluations are springs x force evaluations x
steps; with implicit-euler an application of the Jacobian counts as one. Figures of a software rasterizer do not apply
to GPUs; the table names the renderer.)";

inline constexpr const char* sweep_examples = R"(Examples:
  aspic sweep cube-plane --vary h=0.0005:0.004:8:log --vary integrator=midpoint,runge-kutta-4 --out steps.csv
  aspic sweep cube-plane --vary "cube[0].velocity=[1,0,0],[2,0,0]" --vary mu=0:0.6:7 --out slides.csv
  aspic sweep large-cube --vary backend=cpu,gpu --duration 0.1 --out equal.csv
  aspic sweep my-scene.toml --vary k=100:10000:64:log --out k-3.csv --part 3/8
  aspic sweep cube-plane --vary k=500:8000:3:log --runs sweep   keep each run; skip finished ones

Every combination is a run; the last key varies fastest. h is the time step, k and c the stiffness and damping of all
springs (the first gets the value, the others keep their ratios to it), n the particles per edge of all cubes, e and mu
restitution and friction of all terrain. A run that diverges or is rejected has a row with the reason. After a kill or
Ctrl-C the same command continues. Only the last column, seconds, differs between repeats or values of --jobs. To join
parts: awk 'FNR > 1 || NR == 1' k-*.csv. docs/report.md explains the columns, docs/sweeps.md the folder of --runs.)";

inline constexpr const char* report_examples = R"(Examples:
  aspic report cube-plane --out report              about a minute on two CPU cores
  aspic report my-scene.toml --out mine --thorough
  aspic report cube-plane --only stability --only contact --out part
  aspic report course-2021-plane --set author=Ada --outline course --out outline

report.html is one file, light or dark as the reader's system; report.md has its images in figures/; report.pdf
needs chromium, weasyprint or wkhtmltopdf. The numbers of each figure are in data/.)";

inline constexpr const char* verify_examples = R"(Examples:
  aspic verify                                      all checks (docs/verification.md has the time)
  aspic verify --quick
  aspic verify --only equality --only repeat --require-gpu

Exit code 1 if a check fails. Without a GL device, checks that need one count as not run.)";

}  // namespace aspic
