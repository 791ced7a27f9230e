# The help texts: everything that a user has to know about the launcher.

help_overview() {
  cat <<'TEXT'
Mesograin renders granular materials in real time and compares every picture with Cycles.

  ./mesograin COMMAND [argument ...]

  compare   render a scene with Mesograin and with Cycles; pictures, numbers and a report
  trade     error against time: every model and Cycles itself, the Pareto front drawn
  sweep     compare many cases listed in a file; resumable, on one machine or many
  render    render a scene described in JSON to EXR, without Blender
  bake      bake a grain's surface to an EXR texture, and Cycles' beside it
  test      run the tests
  bench     measure speed and accuracy
  build     build the native module, and nothing else
  package   make a zip of the add-on
  install   install the add-on into Blender and enable it
  help      this text; `./mesograin help COMMAND` or `./mesograin COMMAND --help` for more

Each command first makes sure of what it needs: Debian packages (through apt, with sudo when not root) and an up-to-date
build of the native module. It says a line for each such step, and nothing when all is there. It runs from any folder.

Environment:
  MESOGRAIN_BLENDER      the Blender to use (default: blender on the PATH; --blender PATH goes before it)
  MESOGRAIN_PYTHON       a Python with headers, of the version that Blender embeds (default: /usr/bin/python3.X)
  MESOGRAIN_GL_DEVICE    the EGL device to render on (default: the first that works, hardware before software)
  XDG_CACHE_HOME         where caches live (default: ~/.cache; Mesograin's are in its folder mesograin)

Exit codes:
  0 done   1 failed, or tests failed   2 wrong usage   3 something needed is missing   130 interrupted
TEXT
}

help_compare() {
  cat <<'TEXT'
Renders every model and the Cycles reference that means the same, and writes pictures, numbers and a report.

  ./mesograin compare [SCENE.blend] [option ...]

  SCENE.blend               default: blend_files/sphere.blend
  --models MODEL ...        models to compare: lambert, conductor, model_1, model_2, model_3 (default: all)
  --references KIND ...     kinds of reference: diffuse, glossy, volume_index_matched, subsurface, subsurface_burley,
                            volume_dielectric, photon; each model is compared with those that answer it (default: diffuse
                            for lambert, glossy for conductor, volume_index_matched for the others)
  --out DIR                 folder for results (default: comparison)
  --size WxH                picture size in pixels (default: the scene's)
  --samples N               samples per pixel on our side (default: 64)
  --reference-samples N     samples per pixel for each seed of the reference (default: 64 for surfaces, 128 for
                            volumes, 1024 for volume_dielectric, 256 for photon)
  --seeds K                 independent renders of each reference, whose spread tells its noise; more are added to those
                            in the cache (default: 2)
  --until FRACTION          adds seeds until the reference's noise is at most this fraction of the measured error
  --most-seeds K            how many seeds --until may lead to (default: 64)
  --mask NAME ...           leaves pixels out of the numbers, one mask after another: silhouette:PIXELS,
                            crop:LEFT,TOP,RIGHT,BOTTOM, mean_deviation[:DEVIATIONS], otsu[:MEDIAN_SIZE]
  --controls                also tests the verdict: the reference's renderer in our place, with the same and a wrong material
  --part PART               a part of the light alone: specular, what the surface reflects, or subsurface, what was inside
  --set NAME=VALUE          a material parameter for every material, on both sides: reflectance, sigma_a, sigma_s, g, eta,
                            roughness, scale, profile; RGB as one number or three with commas; may be repeated
  --frames N                frames timed for frame_ms (default: 9)
  --no-report               writes no report.html
  --cache DIR               folder of rendered references (default: MESOGRAIN_CACHE, or mesograin/references in the cache)
  --cache-limit SIZE        bytes that it may take, with an optional K, M or G (default: MESOGRAIN_CACHE_LIMIT, or 2G)
  --clear-cache             empties the reference cache and does nothing else
  --blender PATH            the Blender to use

DIR receives report.html (open it from disk), results.json, results.csv, and EXR and PNG pictures of every model,
reference and error. A second run finds its references in the cache. Ctrl-C stops at once, leaves no half file, and the
next run goes on with what is cached.
Exit codes: 0 all compared, 1 a case failed (the others are written), 2 wrong arguments or scene, 3 something needed is
missing or DIR cannot be written, 130 interrupted.

  ./mesograin compare
  ./mesograin compare my_grain.blend --models lambert model_1 --size 640x480 --out /tmp/mine
TEXT
}

help_trade() {
  cat <<'TEXT'
Measures error against time, for every model at several sample counts and for Cycles itself at rising samples, all against
one converged render of the reference; draws the Pareto front and says how much longer Cycles needs for the same error.

  ./mesograin trade [SCENE.blend] [option ...]

  SCENE.blend               default: blend_files/sphere.blend
  --reference KIND          what the models are measured against, any of compare's references (default:
                            volume_index_matched); with photon the photon tracer takes Cycles' place
  --models MODEL ...        models to measure (default: all that answer the reference)
  --samples N ...           samples per pixel on our side (default: 1 4 16 64)
  --taps N ...              samples of the lit surface that model 3 takes for each of those (default: 4 16 64)
  --reference-samples N     samples per pixel of each of the two seeds of the converged render (default: 512,
                            volume_dielectric 1024)
  --traced-samples N ...    samples per pixel of Cycles' renders that are measured, or of the photon tracer's (default:
                            1 2 4 ... up to a quarter of the converged one)
  --size WxH                picture size in pixels (default: 128x128)
  --frames N                frames whose median is the time of one (default: 25)
  --set NAME=VALUE          a material parameter for every material, on both sides; see ./mesograin help compare
  --out DIR                 folder for what is written (default: trade)
  --cache DIR               folder of rendered references; see ./mesograin help compare
  --cache-limit SIZE        bytes that it may take
  --blender PATH            the Blender to use

DIR receives report.html, trade.json, trade.csv, the plot as SVG and PNG in plots/, and every picture as EXR. Ctrl-C stops at
once; the same command goes on from there. Measure on a quiet machine. The defaults take about five minutes on two cores.
Exit codes: 0 measured, 1 no report could be written, 2 wrong arguments or scene, 3 something needed is missing or DIR cannot
be written, 130 interrupted.

  ./mesograin trade --size 64x64 --reference-samples 128 --out /tmp/trade
TEXT
}

help_sweep() {
  cat <<'TEXT'
Compares every case that a TOML file lists, each in a Blender of its own; docs/sweeps.md describes the file.

  ./mesograin sweep FILE.toml --out DIR [option ...]

  --out DIR               where cases, tables and plots go
  --jobs N                cases side by side (default: 1)
  --list                  print the cases, with their groups, and run none
  --no-report             write the tables, no page and no plots
  --case I                run case I alone, counted from 0
  --group I               run only the cases of group I, which share a reference, counted from 0
  --merge                 merge and plot what is there, run nothing
  --emit slurm|parallel   write a script that runs the cases as a Slurm job array or under GNU parallel
  --blender PATH          the Blender to use

A sweep that was stopped goes on where it was; cases that failed are recorded and tried again by the next run.

  ./mesograin sweep blend_files/sweeps/figure_25_optical_scale.toml --out out/figure_25
TEXT
}

help_render() {
  cat <<'TEXT'
Renders a scene described in JSON to an EXR file; needs no Blender.

  ./mesograin render SCENE.json -o OUT.exr [option ...]

  SCENE.json            geometry, camera, resolution, lights and material; docs/scene-json.md describes it
  -o, --output OUT.exr  linear RGB radiance and coverage, 32-bit float, row 0 at the top
  -m, --model MODEL     lambert, conductor, model_1 or model_2 (default: the best for the material's kind)
  -n, --samples N       samples per pixel (default: 64)
  --seed S              of the samples' places and of the models' own (default: 0)
  --size WxH            pixels, instead of the scene's resolution
  -q, --quiet           no progress, only errors
  --version             the renderer's version

The picture appears complete or not at all.
Exit codes: 0 written; 1 the scene, the device or the output did not serve; 2 wrong command line; 3 something needed is
missing; 130 interrupted.

  ./mesograin render tests/data/sphere.json --model lambert -o sphere.exr
TEXT
}

help_bake() {
  cat <<'TEXT'
Bakes a grain's surface to an EXR texture at its UVs; for a scene in JSON needs no Blender.

  ./mesograin bake SCENE.blend -o OUT.exr [option ...]
  ./mesograin bake SCENE.json -o OUT.exr [option ...]

  -o, --output OUT.exr      linear RGB radiance and coverage; u to the right, v up, row 0 is v = 1
  --object NAME             what to bake (default: the active object, or the only one)
  --model MODEL             lambert, conductor, model_1, model_2 or model_3 (default: the material's)
  --size SIDE or WxH        texels (default: 1024; for JSON the scene's resolution)
  --samples N               samples per texel (default: 64)
  --view-from WHERE         what looks at the surface: above_surface, along its normal (default), or active_camera
  --margin N                texels by which what is baked reaches beyond the UVs (default: 16; for JSON and with --compare 0)
  --set NAME=VALUE          a material parameter; may be repeated
  --half                    16-bit instead of 32-bit floats
  --compare                 also bakes with Cycles: OUT.cycles.exr, OUT.error.exr, a PNG of each, and numbers in OUT.json
  --reference KIND          what Cycles solves: diffuse, glossy, volume_index_matched, subsurface (default: the model's)
  --reference-samples N     Cycles samples per texel for each of two seeds (default: 64 for surfaces, 128 for volumes)
  --blender PATH            the Blender to use

A scene in JSON takes --model, --size, --samples, --view-from and --margin. The texture's header tells how it was made. Files
appear complete or not at all.
Exit codes: 0 written; 1 the object could not be baked; 2 wrong arguments or scene; 3 something needed is missing or the
output cannot be written; 130 interrupted.

  ./mesograin bake blend_files/grain.blend -o grain.exr
  ./mesograin bake blend_files/sphere.blend --compare --model lambert --size 512x256 -o sphere.exr
  ./mesograin bake tests/data/sphere.json --size 512x256 -o sphere.exr
TEXT
}

help_test() {
  cat <<'TEXT'
Runs the tests; the last line printed is their sum, `N passed, M failed`.

  ./mesograin test [PART ...] [--blender PATH] [--blender-4]

  lint       formatting, static analysis, shader validation, shell scripts, what every file must keep to
  physics    the physics library against itself in double precision and against independent oracles
  native     the native module's rooms, and again under the address and undefined-behaviour sanitizers
  python     the Python module and the report, without Blender
  blender    the add-on inside a Blender without a window
  window     the add-on in a real Blender window on a virtual screen

  PART             one or more of the above (default: all)
  --blender PATH   the Blender to test with
  --blender-4      also runs python, blender and window with Blender 4.3 in a Debian 13 root; the first time this sets
                   the root up in the cache folder, which takes a few minutes, 3 GB and root's rights

A part that crashes or runs no test counts as a failure. Logs and JUnit files: build/release/test-results. Exit code: 0 when all
passed, 1 when not.
TEXT
}

help_bench() {
  cat <<'TEXT'
Measures. Times are given as ratios within one run, so that they mean the same on another machine.

  ./mesograin bench [frame] [--frames N] [--json FILE]
  ./mesograin bench accuracy [--models M ...] [--taps N ...] [--out FOLDER]
  ./mesograin bench false_alarms [--groups N] [--kinds KIND ...] [--json FILE]

  frame         what each model costs relative to lambert: shade pass alone, 400x400, sphere, two lights
  --frames N    the median is over so many frames (default: 100)
  --json FILE   also writes the result there

  accuracy      how far each model's sphere is from photon Monte Carlo: ten materials, three indices, five radii, and five g; about twelve minutes
  --models M    only these (default: model_1 model_2 model_3)
  --taps N      model 3's samples per pixel (default: 16 64)
  --out FOLDER  where accuracy.html, accuracy.json and the CSV files go (default: accuracy)

  false_alarms  how often the significance test calls Cycles' renders different that differ in their seed alone; about ten minutes
  --groups N    groups of four seeds for each kind of reference (default: 300)
  --kinds KIND  these, of diffuse, glossy, volume_index_matched, subsurface (default: diffuse volume_index_matched)
  --json FILE   also writes the result there
TEXT
}

help_build() {
  cat <<'TEXT'
Builds the native module and the command-line renderer; silent when they are up to date.

  ./mesograin build [--blender PATH]

  --blender PATH   the Blender whose Python the module is built for

The module lands in build/release and beside the add-on, so that both can import it.
TEXT
}

help_package() {
  cat <<'TEXT'
Makes a zip of the add-on that Blender installs: build/package/mesograin-VERSION.zip.

  ./mesograin package [--blender PATH] [--blender-4] [-o FILE.zip]

  --blender PATH   the Blender whose Python the native module is built for
  --blender-4      also builds the module for Blender 4.3 of Debian 13, in a root in the cache folder (see ./mesograin test --help)
  -o FILE.zip      where the zip goes

The one zip works as an add-on for Blender 3.4 to 4.1 and as an extension for Blender 4.2 and later. Its native modules run
on the Debian they were built for.
TEXT
}

help_install() {
  cat <<'TEXT'
Installs the add-on into the user's Blender and enables it.

  ./mesograin install [--blender PATH]
  ./mesograin install --remove [--blender PATH]

  --blender PATH   the Blender to install into
  --remove         takes the add-on out again

Close Blender first: it saves its preferences when it quits.
TEXT
}

help_about() {
  case $1 in
    overview | help) help_overview ;;
    compare | trade | sweep | render | bake | test | bench | build | package | install) "help_$1" ;;
    *) fail "$exit_usage" "There is no help about '$1'; the commands are compare, trade, sweep, render, bake, test, bench, build, package and install." ;;
  esac
}
