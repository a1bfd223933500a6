# The built-in scenes, in the order in which they are listed for users.
set(scene_files
    cube-plane.toml
    cube-tilted-plane.toml
    cube-sphere.toml
    cube-bowl.toml
    goal-net.toml
    penalty.toml
    flag.toml
    curtain.toml
    ball-pit.toml
    cube-and-balls.toml
    large-cube.toml)
