#!/usr/bin/env bash
# Draws the images of docs/gallery.md and the README's animation: the last frame of a short run of each scene, and the window as
# its tests see it.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
aspic_install all
aspic_build ON programs app_window_tests

images=$aspic_root/docs/images
mkdir -p "$images"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# draw NAME SECONDS SCENE [option …]
draw() {
  local name=$1 seconds=$2
  shift 2
  "$aspic_build_dir/aspic" run "$@" --duration "$seconds" --fps 1 --size 960x540 --frames "$work/$name" --frames-format jpg >&2
  # No file of the repository has more than 150 kB (tests/repository).
  local image; image=$(ls "$work/$name"/*.jpg | tail -1)
  if (($(stat -c %s "$image") > 150000)); then
    ffmpeg -v error -y -i "$image" -q:v 5 "$images/$name.jpg"
  else
    cp "$image" "$images/$name.jpg"
  fi
  echo "docs/images/$name.jpg" >&2
}

# move PART SCENE [option …]: frames of a part of the README's animation
move() {
  local part=$1
  shift
  "$aspic_build_dir/aspic" run "$@" --backend cpu --size 320x360 --no-text --fps 20 --frames "$work/opening-$part" >&2
}
move 0 jelly-figure --duration 3 --speed 0.5 --view color=strain --view 'camera={position=[6.2,9.5,12.5],target=[0.3,4,0.2],fov=27}'
move 1 walker --duration 6 --view color=actuation --view 'scale={from=-0.2,to=0.2}' \
  --view 'camera={position=[0.85,0.5,1.2],target=[0,0.19,0],fov=40}'
move 2 knot --duration 6 --view 'camera={position=[1.6,1.9,4.6],target=[0,1.75,0],fov=42}'
ffmpeg -v error -y -framerate 20 -i "$work/opening-0/frame-%06d.png" -framerate 20 -i "$work/opening-1/frame-%06d.png" \
  -framerate 20 -i "$work/opening-2/frame-%06d.png" -filter_complex hstack=3 -frames:v 120 -c:v libwebp_anim -quality 60 -loop 0 \
  "$images/opening.webp"
echo "docs/images/opening.webp" >&2

draw cube-plane 1.47 cube-plane
draw cube-tilted-plane 1.3 cube-tilted-plane
draw cube-sphere 1.1 cube-sphere
draw cube-bowl 1.5 cube-bowl
draw strain 1.42 cube-plane --view color=strain
draw signed-strain 2.25 flag --view color=signed-strain --view 'scale={ from = -0.05, to = 0.05 }'
draw strain-at-rest 6 cube-plane --view color=strain --view scale.range=automatic
draw springs 1.42 cube-plane --view 'draw=["structural","shear","bending"]'
draw cut 1.05 cube-sphere --view cut.inside=section --view 'cut.normal=[0.2,0,1]' --view color=strain \
  --view 'camera={position=[5,5,9],target=[0.2,2.4,0],fov=45}' --view follow=none
draw contacts 1.4 cube-plane --view 'arrows=["contacts"]' --view axes=true --view 'camera={position=[6,3,9],target=[0,1,0],fov=45}'
draw penalty 1.4 penalty
draw cube-and-balls 0.7 cube-and-balls
draw beside 1.72 cube-plane --set cube[0].structural.damping=1 --set cube[0].shear.damping=1 --set cube[0].bending.damping=1 \
  --variant integrator=implicit-euler --view 'camera={position=[10,5,14],target=[0,2.4,0],fov=45}'
draw beside-four 1.5 cube-plane --variant integrator=implicit-euler --variant h=0.0005 --variant k=8000
draw cube-torus 0.95 cube-torus
draw cube-hole 1.3 cube-hole
draw elevator 2 elevator
draw cubes-stack 6 cubes-stack
draw cubes-tower 2 cubes-tower
draw heap 3 heap
draw squeeze 2 squeeze
draw jelly-in-net 1 jelly-in-net
draw knot 4 knot
draw ball-pit 2.2 ball-pit
draw curtain 1.25 curtain
draw flag 2.25 flag
draw bridge 0.7 bridge
draw swing 0.42 swing --view color=signed-strain
draw jelly-figure 1.6 jelly-figure
draw jelly-figure-strain 0.95 jelly-figure --view color=strain
draw worm 3.2 worm
draw worm-actuation 3.2 worm --view color=actuation
draw walker 2.1 walker
for scene in plane:1.25 tilted-plane:1 sphere:1 bowl:1.2; do
  draw course-2021-${scene%:*} ${scene#*:} course-2021-${scene%:*}
done
draw course-2018 1.1 course-2018
draw course-springs 1.25 course-2021-plane --view 'draw=["structural","shear","bending"]'

"$aspic_build_dir/aspic" report cube-plane --only stability --out "$work/report" >&2
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --blink-settings=preferredColorScheme=1 --window-size=1240,1190 \
  --screenshot="$work/report.png" "file://$work/report/report.html" >&2
ffmpeg -v error -y -i "$work/report.png" -vf scale=960:-1 -q:v 6 "$images/report.jpg"
echo "docs/images/report.jpg" >&2

"$aspic_build_dir/aspic" run cube-plane --view color=strain --html "$work/page.html" >&2
"$aspic_build_dir/aspic" run cube-plane --variant integrator=implicit-euler --variant k=8000 --html "$work/page-beside.html" >&2
/usr/bin/python3 tests/page/shoot.py "$work/page.html" 1.36 "$work/page.png" "$work/page-beside.html" 1.5 "$work/page-beside.png"
"$aspic_root/scripts/wasm.sh"
aspic_build ON programs
"$aspic_build_dir/aspic" run cube-plane --view color=strain --html-live "$work/page-live.html" >&2
/usr/bin/python3 tests/page/shoot.py "$work/page-live.html" 1.36 "$work/page-live.png"
for image in page page-beside page-live; do
  ffmpeg -v error -y -i "$work/$image.png" -q:v 4 "$images/$image.jpg"
  echo "docs/images/$image.jpg" >&2
done

ASPIC_WINDOW_IMAGES=$work tests/support/on_display.sh 1920x1080 \
  "$aspic_build_dir/tests/app/app_window_tests" --gtest_filter='Gallery.*' >&2
for image in "$work"/window-*.jpg; do
  ffmpeg -v error -y -i "$image" -vf scale=1280:-1:flags=lanczos -q:v 4 "$images/${image##*/}"
  echo "docs/images/${image##*/}" >&2
done
