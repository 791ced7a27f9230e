// A job type for Blender's render farm Flamenco: the frames of an animation, in chunks, those that are there left alone.
// Put it into the folder `scripts` beside Flamenco Manager and press Refresh Job Types in Blender. Every worker's Blender
// needs Mesograin installed and enabled. See docs/film.md.

const JOB_TYPE = {
    label: "Mesograin Animation",
    description: "Frames of an animation. Sent again, the job renders what is missing: each frame's file is there whole or not at all.",
    settings: [
        {
            key: "frames", type: "string", required: true,
            eval: "f'{C.scene.frame_start}-{C.scene.frame_end}'",
            evalInfo: { showLinkButton: true, description: "The scene's frames" },
            description: "Frames to render, such as 47, 1-30 or 3, 5-10, 47-327",
        },
        {
            key: "chunk_size", type: "int32", default: 10, propargs: { min: 1 }, visible: "submission",
            description: "Frames of one task: a Blender starts and reads the scene once for all of them",
        },
        {
            key: "render_output_path", type: "string", subtype: "file_path", required: true,
            eval: "bpy.path.abspath(C.scene.render.filepath)",
            evalInfo: { showLinkButton: true, description: "The scene's output path" },
            description: "Where frames go, # for digits. The same path again goes on where an earlier job stopped",
        },
        { key: "blendfile", type: "string", required: true, visible: "web", description: "The scene" },
    ],
};

// Found by the engine, since an extension's modules have another name than an add-on's.
const RENDER_FRAMES =
    "import bpy, importlib, sys; " +
    "engine = next(each for each in bpy.types.RenderEngine.__subclasses__() if getattr(each, 'bl_idname', '') == 'MESOGRAIN'); " +
    "room = engine.__module__.rsplit('.engine.', 1)[0] + '.studies.animation.frames'; " +
    "sys.exit(importlib.import_module(room).main(sys.argv[sys.argv.index('--') + 1:]))";

function compileJob(job) {
    const settings = job.settings;
    for (const chunk of frameChunker(settings.frames, settings.chunk_size)) {
        const task = author.Task(`render-${chunk}`, "blender");
        task.addCommand(author.Command("blender-render", {
            exe: "{blender}",
            exeArgs: "{blenderArgs}",
            argsBefore: [],
            blendfile: settings.blendfile,
            args: ["--python-exit-code", "1", "--python-expr", RENDER_FRAMES, "--",
                `--frames=${chunk}`, "--out", settings.render_output_path],
        }));
        job.addTask(task);
    }
}
