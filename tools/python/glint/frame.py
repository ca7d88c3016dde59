"""What a capture says beside its pixels: cameras, fog, exposure, cube maps. FORMAT.md has the meaning, units and ranges of every value in
full; where these classes say "0: 1", the library takes 0 for 1, as its C interface does.

Positions, directions and lengths are float64, in the engine's units; `metres_per_unit` converts them. Arrays may be given as anything that
numpy.asarray makes numbers of the stated shape. The objects belong to the caller and share nothing with a file or with the library."""
import ctypes
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glint.convert import counted, mirrors, to_struct
from glint.library import function

Floats = NDArray[np.float64]

_position = function("glint_camera_position", "camera position")


def _zeros(*shape: int) -> Any:
    return field(default_factory=lambda: np.zeros(shape))


@mirrors("glint_camera")
@dataclass(eq=False)
class Camera:
    """A camera: clip = view_to_clip · world_to_view · world, for column vectors."""
    world_to_view: Floats
    """(4, 4): a rotation, which may mirror, and a translation; no scale"""
    view_to_clip: Floats
    """(4, 4): a perspective, jitter included: rows (a 0 c 0) (0 b d 0) (0 0 A B) (0 0 ±1 0)"""
    rotation_error: float = 0.0
    """set by the reader where the stored rotation R is only precise to a float: the deviation of R·Rᵀ from the identity"""

    @property
    def position(self) -> Floats:
        """(3,): the camera's world position. Solved for, as a rotation need not be orthonormal to the last bit."""
        found = (ctypes.c_double * 3)()
        _position(ctypes.byref(to_struct(self)), found)
        return np.array(found)


@mirrors("glint_fog")
@dataclass(eq=False)
class Fog:
    """Exponential height fog."""
    color: Floats
    """(3,): radiance far inside the fog, ≥ 0; stored as float32"""
    density: float
    """extinction per unit at `base`, ≥ 0"""
    base: float = 0.0
    """height along up at which the density applies, units"""
    scale_height: float = 0.0
    """units of height over which the density falls to 1/e; 0: the same at every height"""
    adds: bool = False
    """its colour is added, and what lies behind it loses nothing"""


@mirrors("glint_atmosphere")
@dataclass(eq=False)
class Atmosphere:
    """A planet's atmosphere. Lengths are in metres, but for `ground`."""
    planet_radius: float
    """from the middle of the planet to the ground, > 0"""
    top: float
    """altitude at which the atmosphere ends, > 0"""
    irradiance: Floats
    """(3,): radiance · sr, of the sun above the atmosphere, ≥ 0; stored as float32"""
    rayleigh: Floats
    """(3,): scattering by molecules at the ground, 1/m, ≥ 0; stored as float32"""
    ground: float = 0.0
    """height of the ground along up, units: altitudes count from there"""
    rayleigh_height: float = 8000.0
    """altitude at which there are 1/e as many molecules, > 0; 0: 8000"""
    mie: float = 0.0
    """scattering by particles at the ground, 1/m, ≥ 0"""
    mie_extinction: float = 0.0
    """what they scatter and absorb there, at least `mie`"""
    mie_height: float = 1200.0
    """altitude at which there are 1/e as many particles, > 0; 0: 1200"""
    mie_asymmetry: float = 0.0
    """mean cosine of the angle by which particles turn light, between −1 and 1"""


@mirrors("glint_clouds")
@dataclass(eq=False)
class Clouds:
    """Where the clouds of the parts cloud.* lie. Lengths are in metres, but for `ground`."""
    bottom: float
    """altitude of the lower side of the layer, ≥ 0"""
    top: float
    """altitude of its upper side, above `bottom`"""
    tile: float
    """side of the square over which density and height repeat, > 0"""
    extinction: float
    """1/m at a density of 1, ≥ 0"""
    ground: float = 0.0
    """height of the ground along up, units: altitudes count from there"""
    noise_tile: float = 1000.0
    """side of the cube over which the noise repeats, > 0; 0: 1000"""
    erosion: float = 0.0
    """what a noise of 1 takes from the density, ≥ 0"""
    offset: Floats = _zeros(2)
    """(2,): how far the wind has moved the clouds, along the two horizontal world axes"""


@mirrors("glint_material_model")
@dataclass(eq=False)
class MaterialModel:
    """How the engine's materials differ from those of the format."""
    metal_reflectance: float = 1.0
    """reflectance of a metal at normal incidence as a multiple of its albedo, at most 1 in the end; 0: 1"""
    roughest_reflection: float = 0.0
    """surfaces of at least this roughness reflect nothing in the engine; 0: all do"""
    gloss_scale: float = 10.0
    """roughness log2_power: power = 2^(gloss_scale · stored + gloss_offset); both 0: 10 and 1"""
    gloss_offset: float = 1.0


@mirrors("glint_sun")
@dataclass(eq=False)
class Sun:
    """The sun, or the moon, or whatever light is infinitely far away."""
    direction: Floats
    """(3,): unit vector in world space towards it"""
    angular_radius_rad: float = 0.0
    """of its disc, [0, π/2); 0: a point"""
    irradiance: Floats = _zeros(3)
    """(3,): radiance · sr, on a surface that faces it, with nothing between, ≥ 0; stored as float32; zeros: not known"""


@mirrors("glint_cone")
@dataclass(eq=False)
class Cone:
    """Where a spot light shines."""
    axis: Floats
    """(3,): unit vector in world space along which it shines"""
    inner_rad: float
    """angle from the axis up to which it has its full intensity"""
    outer_rad: float
    """angle from the axis from which on it has none, at most π"""


@mirrors("glint_light")
@dataclass(eq=False)
class Light:
    """A point light, or a spot light if it has a cone."""
    position: Floats
    """(3,): world"""
    intensity: Floats
    """(3,): radiant intensity, ≥ 0: at d metres the irradiance on a surface that faces the light is this divided by d²; stored as float32"""
    range: float = 0.0
    """units: the light ends at this distance; 0: it has no end"""
    radius: float = 0.0
    """units: of the lamp, within which nothing casts a shadow; 0: a point"""
    cone: Cone | None = None


@mirrors("glint_stencil_class")
@dataclass
class StencilClass:
    """Pixels with (stencil.id & mask) == value."""
    value: int
    mask: int
    """0: all bits"""
    name: str
    """"sky", "foreground", "character" …; at most 31 bytes"""


@mirrors("glint_frame")
@dataclass(eq=False)
class Frame:
    """The frame's own attributes. Only the camera has no default."""
    camera: Camera
    previous: Camera | None = None
    """the camera one frame earlier; needed with a part previous.gbuffer"""
    cut: bool = False
    """the previous frame belongs to another shot"""
    player: Floats | None = None
    """(3,): world position around which cube maps are selected; None: the camera's"""
    jitter_px: Floats = _zeros(2)
    """(2,): the sub-pixel offset that view_to_clip contains; +x right, +y down"""
    exposure: float = 1.0
    """factor from scene-referred to display, > 0; 0: 1"""
    pre_exposure: float = 1.0
    """factor that pre-exposed colour contains, > 0; 0: 1"""
    metres_per_unit: float = 1.0
    """> 0; 0: 1"""
    depth_near: float = 0.0
    """near plane of logarithmic depth, units"""
    depth_far: float = 0.0
    """far plane of logarithmic depth, units"""
    motion_range: float = 1.0
    """packed motion: the uv offset of the largest value; 0: 1"""
    motion_depth_range: float = 1.0
    """packed motion.Z: the depth difference of the largest value, units; 0: 1"""
    number: int = 0
    """frame number, 0 to 2³² − 1; seeds random numbers that differ from frame to frame"""
    up: str = "+y"
    """world axis that points up: +y, +z, +x, -y, -z, -x"""
    clip_y: str = "up"
    """where NDC y = +1 is: "up" (top of the picture) or "down\""""
    clip_z: str = "zero_to_one"
    """range of NDC z: "zero_to_one" or "minus_one_to_one\""""
    fog: Fog | None = None
    classes: list[StencilClass] = counted("class_count", list)
    """at most 32"""
    material: MaterialModel | None = None
    sun: Sun | None = None
    lights: list[Light] = counted("light_count", list)
    """at most 64"""
    atmosphere: Atmosphere | None = None
    clouds: Clouds | None = None
    lut_stops: Floats | None = None
    """(2,): the part lut is looked up by linear light between these stops, see lutStops in FORMAT.md; None: by sRGB-encoded colours"""


@mirrors("glint_cubemap")
@dataclass(eq=False)
class CubeMap:
    """The attributes of a part cubemap.NNN. The inner volume contains no surface at all: see FORMAT.md before you set one."""
    center: Floats
    """(3,): world position"""
    outdoor: bool = False
    fade: float = 1.0
    """weight while it is faded in or out, (0, 1]; 0: 1"""
    age_frames: int = 0
    """0 to 2³² − 1"""
    inner: str = "none"
    """"none", "box", "sphere" or "hull"; positions below are relative to the centre, in units"""
    box_min: Floats = _zeros(3)
    box_max: Floats = _zeros(3)
    sphere_center: Floats = _zeros(3)
    sphere_radius: float = 0.0
    planes: Floats = counted("plane_count", lambda: np.zeros((0, 4)))
    """(n, 4), n ≤ 64: planes (n, d) of a hull, inside where n·p + d ≤ 0"""


@mirrors("glint_sky")
@dataclass(eq=False)
class Sky:
    """The attributes of the part sky."""
    ground: float | None = None
    """elevation in degrees, −90 to 90, below which it shows painted ground; None: sky everywhere"""


@mirrors("glint_probe_box")
@dataclass(eq=False)
class ProbeBox:
    """The box on which everything in a probe is taken to lie, units."""
    center: Floats
    """(3,): world position"""
    min: Floats
    """(3,): relative to the centre"""
    max: Floats


@mirrors("glint_probe")
@dataclass(eq=False)
class Probe:
    """The attributes of a part probe.NNN or of one of its levels, probe.NNN.level1 …; ground and box are those of the finest."""
    roughness: float | None = None
    """perceptual roughness of the surfaces that look up this level; None: levels are spread evenly over [0, 1]"""
    ground: float | None = None
    """as in Sky"""
    box: ProbeBox | None = None
    """None: everything is infinitely far away"""


@mirrors("glint_indirect")
@dataclass(eq=False)
class Indirect:
    """The attributes of the part indirect."""
    occluded: bool = False
    """the engine's own ambient occlusion is already in it"""


@mirrors("glint_shadow")
@dataclass(eq=False)
class Shadow:
    """The attributes of a part shadow.NNN."""
    world_to_shadow: Floats
    """(4, 4), invertible: after division by w, x from −1 to 1 is the map from left to right, y as clip_y says, z the depth that is stored"""
    range: Floats = field(default_factory=lambda: np.array([0.0, 1.0]))
    """(2,): the depths nearest to the light and farthest from it, in [0, 1]"""
    bias: float = 0.0
    """what the engine adds to the stored depth, away from the light, before it compares, ≥ 0"""
    light: int | None = None
    """the number of the light in Frame.lights; None: the sun's"""
    stencil_class: int | None = None
    """the number of the class in Frame.classes whose surfaces alone are compared with the map; None: all surfaces"""


@mirrors("glint_light_volume")
@dataclass(eq=False)
class LightVolume:
    """The attributes of a part volume.NNN: a grid of ambient cubes, slices one below the other."""
    world_to_grid: Floats
    """(4, 4), invertible, last row 0 0 0 1: cell (i, j, k) lies from (i, j, k) to (i + 1, j + 1, k + 1)"""
    slices: int
    """cells along z, ≥ 1"""


@mirrors("glint_froxels")
@dataclass(eq=False)
class Froxels:
    """The attributes of the part froxels: light in the air, in slices of the view frustum, one below the other."""
    slices: int
    """≥ 1"""
    near_depth: float
    """view-linear depth in units at which the first slice begins, ≥ 0; above 0 if they are exponential"""
    far_depth: float
    """view-linear depth in units at which the last slice ends"""
    exponential: bool = False
    """each slice is so many times as thick as the one before; False: all are equally thick"""


@mirrors("glint_truth")
@dataclass(eq=False)
class Truth:
    """How far a path tracer went, in units: radius for the part truth.occlusion, length for the contact shadow of truth.sun."""
    radius: float = 0.0
    length: float = 0.0


@mirrors("glint_planar")
@dataclass(eq=False)
class Planar:
    """The attributes of a part planar.NNN: a render mirrored in a plane."""
    plane: Floats
    """(4,): (n, d) in world space, n·p + d = 0"""
    camera: Camera
    """the mirrored camera"""


@mirrors("glint_encodings")
@dataclass
class Encodings:
    """How the engine stored a part's channels. Each value is one of its list in FORMAT.md; the first, which is the default, is what the
    reader decodes to."""
    depth: str = "view_linear"
    normal: str = "signed"
    vertex_normal: str = "signed"
    normal_space: str = "world"
    roughness: str = "perceptual"
    motion: str = "uv"
    color: str = "linear"
    motion_depth: str = "view_linear"
