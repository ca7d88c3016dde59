"""The kinds of rows that a declaration (VARIANT.pass.h, slot.h) may hold: the one place where a kind is written.

A declaration is read several times, each time with other macros of the same names. passes/table.py writes these macros from this table:

    names.h                 C, first reading: names that the second one uses as constants
    rows.h                  C, second reading: each row becomes a struct glint_row
    row_kinds.h             C, public: enum glint_row_kind
    effect_rows.h           C: EFFECT_KINDS, with which EFFECT/effect.h becomes a struct glint_effect
    shared/bindings.glsl    GLSL, first reading: images become bindings, constants specialization constants
    shared/push_begin.glsl  GLSL, second reading: push constants

To add a kind, add a Kind here. Its fields:

    name, parameters   the macro: Kind('READ', 'kind, image', …) is written READ(texture2D, depth_half) in a declaration
    about              what a row of the kind says; it becomes the comment at the value of enum glint_row_kind
    row                initialisers of struct glint_row (include/glint/passes.h), beside .kind and .id, which every row has
    names              what the first reading in C makes of it
    bindings, push     what the readings in GLSL make of it
    as_kind            the kind under which C sees it, when it is another spelling of that one

In texts $x stands for the macro's parameter x. __LINE__ is the row's line, which is its binding or constant id in both languages: nothing
is numbered by hand, and `#line` in slot.h and the shared rows keeps the lines of different files apart.
"""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Kind:
    name: str
    parameters: str
    about: str
    row: str = '.name = ""'
    names: str = ''
    bindings: str = ''
    push: str = ''
    as_kind: str = ''


# Written images have no format in GLSL, so that the host can store them as half or float without recompilation.
BINDING = 'layout(set = 0, binding = __LINE__) uniform $kind $image;'
# HALF_FORMAT is true for half floats, whose range imageStore() keeps to (shared/interface.glsl).
WRITTEN = 'layout(set = 0, binding = __LINE__) uniform writeonly $kind $image; const bool is_half_##$image = HALF_##$format;'
OPTIONAL = BINDING + ' layout(constant_id = 1000 + __LINE__) const bool has_##$image = true;'
LIST = OPTIONAL.replace('$kind', 'utextureBuffer').replace('$image', '$list')
CHAIN = 5  # levels that WRITE_LEVELS and DISPATCH_CHAIN write in one dispatch
# In C a DISPATCH_LIST is a READ of the list, too.
READ_LIST = ('}, {.kind = GLINT_ROW_READ, .id = __LINE__, .name = #$list, .glsl = "utextureBuffer", .optional = true, '
             '.format = GLINT_FORMAT_R32UI, .size = GLINT_SIZE_LIST, .fallback = 0xFFFFFFFFu')
IMAGE = ('.name = #$image, .glsl = #$kind, .format = GLINT_FORMAT_##$format, .size = GLINT_SIZE_##$size, .unit = $unit, '
         '.channels = $channels, .fallback = (double)($fallback), .help = $meaning')
VALUE = ('.name = #$name, .type = VALUE_##$type, .initial = (double)($initial), .lowest = (double)($lowest), '
         '.highest = (double)($highest), .unit = $unit, .source = $source, .help = $help')


def choice(*options):
    """CHOICE2 for two options, and so on."""
    places = ', '.join(f'PLACE($name, ${o})' for o in options)
    values = ' '.join(f'const int $name##_##${o} = {i};' for i, o in enumerate(options))
    return Kind(
        f'CHOICE{len(options)}', f'name, initial, {", ".join(options)}, source, help',
        'A parameter as a specialization constant with named values (CHOICE2 to CHOICE5).', as_kind='CHOICE',
        names=f'enum {{ {places} }};',
        row=(f'.name = #$name, .type = GLINT_VALUE_INT, .initial = PLACE($name, $initial), .lowest = 0, .highest = {len(options) - 1}, '
             '.unit = "1", .source = $source, .help = $help, .choices = (const char *const[]){'
             + ', '.join(f'#${o}' for o in options) + ', NULL}'),
        bindings=values + ' layout(constant_id = __LINE__) const int $name = $name##_##$initial;')


KINDS = [
    Kind('PASS', 'title, source', 'Title of the pass, and the document that it is from (docs/sources.md).',
         row='.name = $title, .source = $source',
         names='static const char PASTE2(title, PASS_ID)[] = $title, PASTE2(source, PASS_ID)[] = $source;'),
    Kind('SLOT', 'title', 'Title of the slot.', row='.name = $title'),

    # ---- Images ----
    Kind('READ', 'kind, image',
         'An image that another pass or the capture makes. All its levels are one texture. Cube maps are read as textureCube or '
         'textureCubeArray, or as texture2DArray (layers as for WRITE) where the texel is known and neither filter nor face selection is needed.',
         row='.name = #$image, .glsl = #$kind', bindings=BINDING),
    Kind('READ_AS', 'kind, name, image', 'A READ whose binding has another name, where that of the image is taken.',
         row='.name = #$image, .glsl = #$kind', bindings=BINDING.replace('$image', '$name'), as_kind='READ'),
    Kind('OPTIONAL_READ', 'kind, image, format, size, fallback',
         'A READ of an image that need not exist. has_NAME is false in the shader when no pass makes it, and its fallback value is bound.',
         row='.name = #$image, .glsl = #$kind, .optional = true, .format = GLINT_FORMAT_##$format, .size = GLINT_SIZE_##$size, '
             '.fallback = (double)($fallback)',
         bindings=OPTIONAL, as_kind='READ'),
    Kind('READ_BESIDE', 'kind, image, format, size, fallback, others',
         'An OPTIONAL_READ of an image of the capture, which is read only where a pass of the pipeline makes one of the others: names between '
         'spaces. Otherwise the capture is not asked for it.',
         row='.name = #$image, .glsl = #$kind, .optional = true, .format = GLINT_FORMAT_##$format, .size = GLINT_SIZE_##$size, '
             '.fallback = (double)($fallback), .beside = $others',
         bindings=OPTIONAL, as_kind='READ'),
    Kind('READ_OWN', 'kind, name, image', 'All levels of an image that this pass writes, to read; `name` is the binding\'s.',
         row='.name = #$name, .image = #$image, .glsl = #$kind', bindings=BINDING.replace('$image', '$name')),
    Kind('WRITE_LEVELS', 'kind, name, image',
         'An image with levels that this pass writes, for dispatches that write several (DISPATCH_CHAIN): name[i] is level dispatch_level + i for i up '
         'to 4. Nothing may be written to a level that the image has not.',
         row=f'.name = #$name, .image = #$image, .glsl = #$kind, .chain = {CHAIN}',
         bindings=f'layout(set = 0, binding = __LINE__) uniform writeonly $kind $name[{CHAIN}]; '
                  f'const bool is_half_##$name[{CHAIN}] = bool[]({", ".join(["is_half_##$image"] * CHAIN)});'),
    Kind('HISTORY', 'kind, name, image',
         'The contents of an image of the pipeline, not of the capture, at the end of the previous frame, valid where frame.flags.x is 1; the '
         'image\'s fallback value if its pass was dropped in that frame. Otherwise one texel with that value. `name` is the binding\'s.',
         row='.name = #$name, .image = #$image, .glsl = #$kind', bindings=BINDING.replace('$image', '$name')),
    Kind('WRITE', 'kind, image, format, unit, size, channels, fallback, meaning',
         'An image that this pass makes. An image with levels (a size class ..._MIPS) is written one level at a time: dispatch_level, whose size '
         'imageSize() gives. Cube maps are written as image2DArray: layer 6 * cube + face (faces +X -X +Y -Y +Z -Z), which is '
         'gl_GlobalInvocationID.z. A LIST is a buffer of uints (uimageBuffer, read as utextureBuffer) of tiles, laid out as in '
         'shared/work_list.h. Nothing clears it; the words after the items are scratch space of the pass that makes it.',
         row=IMAGE, bindings=WRITTEN),
    Kind('DIAGNOSTIC', 'kind, image, format, unit, size, channels, fallback, meaning',
         'A WRITE that is made only when diagnostics are on; a stand-in of 1 x 1 is bound otherwise.', row=IMAGE, bindings=WRITTEN),
    Kind('CAPTURE', 'image, format, unit, size, role, channels, required, fallback, meaning',
         'An image that comes from the capture (passes/capture_images.h); role and channels are those of capture-format/FORMAT.md.',
         row='.name = #$image, .format = GLINT_FORMAT_##$format, .size = GLINT_SIZE_##$size, .unit = $unit, .role = $role, '
             '.source = $channels, .required = $required, .fallback = (double)($fallback), .help = $meaning'),

    # ---- Parameters ----
    Kind('SPEC', 'type, name, initial, lowest, highest, unit, source, help',
         'A parameter as a specialization constant, for what changes loops or code paths.', row=VALUE,
         bindings='layout(constant_id = __LINE__) const $type $name = $type($initial);'),
    choice('a', 'b'),
    choice('a', 'b', 'c'),
    choice('a', 'b', 'c', 'd'),
    choice('a', 'b', 'c', 'd', 'e'),
    Kind('PUSH', 'type, name, initial, lowest, highest, unit, source, help', 'A parameter as a push constant, for what varies cheaply.',
         row=VALUE, push='$type $name;'),
    Kind('ROLE', 'role, name', 'What this image or parameter is to replay and study, which know none by name: enum glint_pass_role.',
         row='.name = "", .image = #$name, .first = GLINT_ROLE_##$role'),
    Kind('ENCODED_BY', 'image, parameter', 'This image of the pass is encoded as the choice of the parameter says, by a name of the encoding `color` of capture-format/FORMAT.md. '
         'Run folders state it, and commands heed it.', row='.name = #$image, .assigned = #$parameter'),
    Kind('TRACER', 'label, image', 'The pass traces rays: tables call it by the label, and `image`, a DIAGNOSTIC, holds why each ray ended.',
         row='.name = $label, .image = #$image'),
    Kind('ASSUMED', 'parameter',
         'This parameter stands for something that the capture does not contain, such as how thick objects are. `glint reference` halves and '
         'doubles it to find how far the answer depends on it.', row='.name = #$parameter'),

    # ---- Dispatches ----
    # The dispatches of a pass run in the order of their rows. dispatch_phase is the row's number among them, from 0: a constant, so that the
    # code of other phases costs nothing even on devices that do not skip a branch that no invocation takes.
    Kind('DISPATCH', 'image',
         'One invocation for each pixel of an image, for cube maps in each face; over a LIST, one workgroup for each 64 x 64 pixels of the picture.',
         row='.name = #$image'),
    Kind('DISPATCH_LEVELS', 'image, first, last, order',
         'One dispatch for each level of an image from first to last, both included, in the order `down` (fine to coarse) or `up`; negative '
         'numbers count from the coarsest, which is -1.',
         row='.name = #$image, .first = $first, .last = $last, .order = GLINT_ORDER_##$order'),
    Kind('DISPATCH_LEVELS_BY', 'image, width, first, last, order',
         'DISPATCH_LEVELS that counts from the finest level that is no wider than the parameter: 0 is that one, -1 the next finer; numbers '
         'beyond the existing levels are clamped to them.',
         row='.name = #$image, .assigned = #$width, .first = $first, .last = $last, .order = GLINT_ORDER_##$order', as_kind='DISPATCH_LEVELS'),
    Kind('DISPATCH_CHAIN', 'image',
         'Behind a DISPATCH over level 0, the other levels. On a GPU, where a dispatch takes longer than its work on small levels, each one writes the '
         'level that it runs over and the next coarser ones, CHAIN = 5 in all (WRITE_LEVELS): the DISPATCH levels 0 to 4, then one dispatch levels 5 '
         'to 9, and so on. On a CPU, where a barrier in a workgroup takes longer, CHAIN is 1: each level has its own dispatch, and workgroups are 8 x 8.',
         row=f'.name = #$image, .chain = {CHAIN}, .last = -1, .order = GLINT_ORDER_down',
         bindings=f'layout(constant_id = __LINE__) const int CHAIN = {CHAIN};', as_kind='DISPATCH_LEVELS'),
    Kind('DISPATCH_LIST', 'list, range',
         'Behind a DISPATCH and instead of it when a pass makes this list: over the tiles of that range (shared/work_list.h), and with tile_works '
         'false over the others, to write what the images hold there. The shader gets its texel from tile_texel() (shared/work_list.glsl). Of '
         'several rows the first whose list is made counts. The list is an OPTIONAL_READ, too.',
         row='.name = #$list, .first = RANGE_##$range' + READ_LIST, bindings=LIST),
    Kind('DISPATCH_LIST_BY', 'list, range, parameter',
         'DISPATCH_LIST of the range smooth or rough, whose limit is the parameter: the largest roughness of a smooth surface, the smallest of a '
         'rough one.', row='.name = #$list, .image = #$parameter, .first = RANGE_##$range' + READ_LIST,
         bindings=LIST, as_kind='DISPATCH_LIST'),
    Kind('WORKGROUP', 'width, height', 'Invocations of a workgroup; 8 x 8 without this row.', row='.name = "", .first = $width, .last = $height'),
    Kind('BLOCKS', 'across',
         'On a CPU an invocation works on so many texels each way, from BLOCK * gl_GlobalInvocationID on; on a GPU, where neighbouring '
         'invocations run side by side, on one.',
         row='.name = "", .first = $across', bindings='layout(constant_id = __LINE__) const int BLOCK = $across;'),
    Kind('PER_RAY', '', 'The passes of this slot run once for each ray of a frame.'),
    Kind('ACCUMULATE', 'image', 'An image that becomes its mean over the rays of a frame.', row='.name = #$image'),
    Kind('RESOLUTION', 'size', 'The pipeline\'s half resolution becomes full while this variant is in its slot.', row='.name = #$size'),

    # ---- When the pass is needed, and what replaces it ----
    Kind('FACT', 'fact',
         'A constant fact_NAME in the shader: false when the survey found nothing of the kind in the frame, so that the code for it is left '
         'out. Of an image that the pass makes: false when no pass that runs reads it; it is not made then, and must not be written.',
         row='.name = #$fact', bindings='layout(constant_id = __LINE__) const bool fact_##$fact = true;'),
    Kind('NEEDS', 'fact', 'The pass is needed only when this fact holds for the capture.', row='.name = #$fact'),
    Kind('CALLED_BY', 'fact, image',
         'Of a pass with such rows one has to call for it: one whose fact holds and whose image, an OPTIONAL_READ, is made by a pass of the pipeline. '
         'That image is then required, as with READ. If the pipeline makes none of the images, the first row counts.',
         row='.name = #$fact, .image = #$image'),
    Kind('NEEDS_MADE', 'image', 'The pass is needed only where the pass that makes this image, which it reads, is.', row='.name = #$image'),
    Kind('NEEDS_BY', 'fact, parameter', 'NEEDS of a fact about a parameter of the pass.',
         row='.name = #$fact, .image = #$parameter', as_kind='NEEDS'),
    Kind('IN_PLACE_OF', 'image, other, on, off, why',
         'Where the pipeline makes `image`, and of the pass\'s parameters `on` is on and `off` is off, the pass does not use `other`, which it reads as an '
         'OPTIONAL_READ. Passes whose images no other pass uses then are left out, unless their images are looked at for themselves.',
         row='.name = #$image, .image = #$other, .assigned = #$on, .source = #$off, .help = $why'),
    Kind('NEEDS_READER', 'image, slot, why', 'The pass in `slot` has to read `image`, which this pass makes, since else something would be missing in the result: why.',
         row='.name = #$image, .image = #$slot, .help = $why'),
    Kind('NEEDED_IF_READ', '', 'The pass is needed, too, when a pass that runs reads one of its images, whatever its rows NEEDS say, unless it needs cube maps and the capture has none.'),
    Kind('WITHOUT', 'image, what', 'What the pass does where the capture does not have this image, which it reads. The plan says so. Passes that read the image without '
         'such a row do not depend on it, if others have one.',
         row='.name = #$image, .help = $what'),
    Kind('READS_LEVELS', 'image, parameter',
         'The pass reads this image only where the parameter is not 0, and then even if no ray has a cone.',
         row='.name = #$parameter, .image = #$image'),
    Kind('BYPASS', 'image, from',
         'When the facts that the pass needs do not hold, `image` would equal this image that it reads: while the pass is dropped, the next '
         'frame finds that one as its history. Of several rows the first whose image is made counts.',
         row='.name = #$from, .image = #$image'),
    Kind('ALIAS', 'image, captured',
         'When the facts that the pass needs do not hold, `image` equals this image of the capture: while the pass is dropped, both names are '
         'one image on the device. `image` may be one of the capture, too: the pass then makes it in place of that.', row='.name = #$captured, .image = #$image'),
    Kind('ALL_VISIBLE_UNLESS', 'parameter', 'While this parameter is off, the reflection of every surface is visible, whatever its material.',
         row='.name = #$parameter'),
    Kind('ALONG_RAYS', 'image, normals',
         'Of these cube maps the pass looks up only what lies along the rays of an image of normals as the cube maps\' centres see them, and no '
         'farther than a texel beside it. In the pass that makes `image`: it holds normals, and its mirror rays are those of `normals`.',
         row='.name = #$image, .image = #$normals'),
    Kind('RAY_MARGIN', 'texels', 'Behind a DISPATCH: cube-map faces that no ray comes nearer to than this may be left out where the images are '
         'looked up along rays alone (ALONG_RAYS).', row='.name = "", .first = $texels'),

    # ---- The preset `reference`, and the players of glint blame: each slot has one of the first two ----
    Kind('REFERENCE', '', 'This variant is its slot\'s reference.'),
    Kind('REFERENCE_NONE', 'why', 'The slot\'s reference is to leave it out.', row='.name = "", .help = $why'),
    Kind('REFERENCE_SET', 'slot, parameter, value',
         'A parameter value of the reference that is not the default. If the parameter is another slot\'s, it matters to this slot alone.',
         row='.name = #$parameter, .image = #$slot, .assigned = #$value'),
    Kind('REFERENCE_WITH', 'slot, why', 'Neither this slot nor the one named is exchanged for its reference without the other.',
         row='.name = #$slot, .help = $why'),
]

# The rows of EFFECT/effect.h, which declares an effect. `row` is an initialiser of struct glint_effect (include/glint/passes.h).
EFFECT_KINDS = [
    Kind('EFFECT', 'place, title, noun, about',
         'Its place among the effects: where a command handles one, the first counts. Its title, what texts call its result, and what it is.',
         row='.title = $title, .noun = $noun, .about = $about,'),
    Kind('RESULTS', '...', 'The images that may be its result, in the order of preference: the first that the run makes in full resolution.',
         row='.results = {__VA_ARGS__},'),
    Kind('TRUTH', 'part, channels',
         'The part of a capture that holds the true result, and its channels, as many as are judged of the result. A channel `weight` is 0 where the '
         'truth is unknown, `error` its relative standard error; it need have neither.', row='.truth = $part, .channels = $channels,'),
    Kind('TRUTH_BY', 'role, part, channels', 'TRUTH of which there are several, each called after a choice of the parameter with this ROLE: PART.CHOICE.',
         row='.truth = $part, .channels = $channels, .truth_by = GLINT_ROLE_##$role, .truth_has_choices = true,'),
    Kind('TRUTH_CHANNEL_BY', 'role, channels', 'Beside TRUTH: its channel is one of these, between spaces, by the place of the choice of the parameter with '
         'this ROLE; the last one where a pipeline does not have the parameter.', row='.channel_by = GLINT_ROLE_##$role, .channel_choices = $channels,'),
    Kind('NO_TRUTH', 'channels, why', 'No part of a capture judges the effect: the channels of its result, and why there is no truth of them. Commands that judge '
         'say so where the effect is asked for by name, and leave it out otherwise.', row='.channels = $channels, .no_truth = $why,'),
    Kind('RAYS', 'part', 'The part whose distance.Z is where the rays of surfaces of the first class truly end.', row='.rays = $part,'),
    Kind('JUDGED_IN', 'pixels', 'The pixels that count: enum glint_judged.', row='.judged = GLINT_JUDGED_##$pixels,'),
    Kind('CALLED_FOR', 'fact', 'The fact (facts.h) without which a frame does not call for the effect.', row='.fact = #$fact,'),
    Kind('CLASSES', 'title, part, channel, classes',
         'Groups of pixels with figures of their own, by a channel of the capture: at most GLINT_EFFECT_CLASSES, each a CLASS. In captures without the '
         'channel no pixel has a class.', row='.class_title = $title, .class_part = $part, .class_channel = $channel, .classes = {$classes},'),
    Kind('CLASS', 'name, most', 'A class, and its highest value; INFINITY for the last one.', row='{$name, $most},'),
    Kind('TERM', 'text', 'How the composed picture changes by it.', row='.term = $text,'),
    Kind('OF_ALL_EFFECTS', '', 'The result is made of all effects: their passes, rays and parameters count as its own. It is judged where it is asked for by name.',
         row='.of_all = true,'),
]
