# What takes above 4 s of CPU time, on two AMD EPYC cores with other work beside: run by `./check full`, not by `./check`.
# The costs are seconds, so that ctest starts with the longest before it has times of its own: one that is started last
# keeps one core busy while the others wait. A name that no test has any more is ignored.
# trueshade_slow(COST NAMES...)
macro(trueshade_slow cost)
  set_tests_properties(${ARGN} PROPERTIES COST ${cost} LABELS slow)
endmacro()
trueshade_slow(40
  "gl:llvmpipe draws every scene and preset as we do, off edges, within a code"
  "judge:Our own frames are explained under every preset and strategy"
  "judge:What llvmpipe draws is explained under every preset and strategy, by its profile and by any GPU's"
  "judge:Wrong renderers are rejected wherever they leave the legal sets")
trueshade_slow(20
  "cli:what OpenGL draws here is explained, pixel by pixel"
  "gl:llvmpipe encodes every float from 0 to 1 as the sRGB code of the profile"
  "judge:A gain, a level or a scale of all lookups is convicted though each of them is legal"
  "judge:Lookups that go one legal way all over an image are not convicted"
  "judge:Our own textured frames are EXACT or TEX to the ideal profile, and legal for any GPU"
  "judge:What llvmpipe draws is explained by its profile and by any GPU's, and its profile is inferred"
  "judge:Glass with maps of metal, emission and occlusion by llvmpipe is explained, and a wrong map of it is not"
  "judge:What llvmpipe makes of maps of metal, emission and occlusion, and of unlit surfaces, is legal"
  "judge:What llvmpipe makes of textures is legal: every format, wrap and filter, and masks"
  "raster:All built-in scenes show what Embree's rays hit at 800 x 800, away from edges and depth ties")
trueshade_slow(10
  "judge:A software device of Vulkan is not convicted under states drawn at random"
  "judge:SwiftShader is not convicted by its profile under states drawn at random"
  "judge:Our own frames are not convicted under states drawn at random"
  "judge:llvmpipe is not convicted under states drawn at random"
  "judge:What llvmpipe makes of both sides, mirrored instances and further texture coordinates is legal"
  "cli:frames take what is predicted, within a fifth, and are refused where that is over the cap"
  "docs: what docs/tutorial.md shows runs"
  "gl:A tile lists every light that lights one of its pixels, and few that light none"
  "gl:Every OpenGL design draws textured materials, and spot lights in their cones"
  "gl:Shaders written with --maps draw the same bytes as the judge's own where materials have maps of every kind"
  "judge:Our own frames of every built-in scene are explained, pixel by pixel"
  "judge:Our own frames with maps of metal, emission and occlusion are legal, for the ideal profile and for any GPU"
  "judge:Wrong ways of drawing lights one by one are rejected light by light"
  "judge:llvmpipe's own wrong blends are rejected light by light, under its profile too"
  "shading:0, 1, 757 and 100,000 lights give one image, culled or not, under every preset and strategy"
  "shading:Row 33 over all floats in [0, 1]: 8-bit stores never fall"
  "shading:hostile numbers in a scene's text: a frame without NaN, or exit code 3 or 4 in one line")
trueshade_slow(4
  "judge:Maps of which one is decoded after it is filtered, and the other before, are convicted together, not apart"
  "cli:wherever memory ends, the command ends in order"
  "allocations:A frame after the first asks for the memory of its picture, and a few times more, whatever the scene"
  "cli:A wrong channel goes by the name that its plane gives it"
  "cli:Depths in halves and identifiers read as floats are refused in one line, not judged in thousands"
  "cli:Of the profiles that were tried the one with the fewest pixels against it, over all stages, comes first"
  "cli:bench's report shows peers, tiles' costs on more cores, and how frames scale"
  "docs: what README.md shows runs"
  "docs: what docs/exit_codes.md shows runs"
  "docs: what docs/validation.md shows runs"
  "gl:Every OpenGL design draws glass after the lights, and the deferred ones in the colour plane"
  "gl:Every OpenGL design draws maps of metal, emission and occlusion, and unlit surfaces"
  "gl:Every OpenGL design draws our picture under every preset"
  "gl:Planes of ten bits and of halves on llvmpipe are legal, and so is the light upon them"
  "gl:Shaders written by trueshade glsl, read back, draw the same bytes as the judge's own"
  "gl:Supersampling and the edge filter on llvmpipe are ours, bit for bit"
  "judge:Both sides and every set of texture coordinates in our own frames are explained, wrong ones are not"
  "judge:Both blenders we know are in the legal sets, and each is the whole of its own profile's"
  "judge:Halves truncated after each of 256 lights are legal where they should be nearest, and not what chance makes"
  "judge:Our depths of another offset are violations under every profile"
  "judge:Row 57: what softpipe lights is within a fifth of the bound"
  "judge:The bound on lighting holds for N lights and shininess s, and is within reach"
  "judge:What llvmpipe clears is explained in every target format, whatever the colour"
  "judge:Wrong lookups are violations: another wrap, another filter, a shifted texture, a mask not applied"
  "judge:llvmpipe's blends into every target format are explained, whatever the equation and the factors"
  "judge:llvmpipe's sRGB and ten-bit codes are its profile's nominal ones, any GPU's takes them for a lean, and none for wrong"
  "judge:softpipe keeps a negative first colour in its cache: those pixels are rejected, and that is the reason"
  "raster:Culling by depth changes no bit, whatever the depth format and the offset"
  "raster:Row 18: the order in which a triangle names its vertices changes no bit"
  "raster:Textured frames show what the scalar renderer shows: masked surfaces, colours times texels"
  "raster:Where two triangles lie on both sides of their edge no pixel is hit twice and none on the edge is missed"
  "scenes:each built-in scene has its numbers and its hash"
  "scenes:every built-in scene takes any number of lights"
  "shading:1,000,000 lights are the naive sum of 1,000,000 terms, bit for bit"
  "shading:Frames of 800x800 have their hash by every fast path and by none"
  "shading:Lists of many lights, region by region, change no bit on any target, by any tiles, under any preset"
  "shading:Pictures by multipass and by full-screen volumes differ at coincident faces alone, which are added up"
  "shading:Row 48: llvmpipe's 8-bit blending follows the integer formula, all 2^24 triples of nine modes on one target"
  "shading:Rows, groups and outlines that a thread keeps follow every number of a light, the model and the extents"
  "shading:The profile's snapping is float32's with one fused multiply-add, on every SIMD target and tile size"
  "shading:Transparent fragments are blended as the naive twin blends them, bit for bit, in both modes"
  "shading:every term, falloff, cone and order of a light model has the naive loop's bits"
  "shading:hostile numbers in C++ values: a frame without NaN, or a refusal"
  "shading:the benchmark scenes are as hard as they are meant to be")
# Tests that are tagged [slow] or [long] in their files.
set_tests_properties(
  "shading:every built-in scene has one hash over pairs of all ways to draw it"
  PROPERTIES COST 32)
set_tests_properties(
  "gl:llvmpipe draws every preset in every strategy as we do, within two codes of a target that rounds light by light"
  "judge:Maps, ten-bit normals, mixed extents and glass by llvmpipe are explained under every preset and strategy"
  "raster:A million pairs of triangles hit no pixel twice along their edge and miss none"
  PROPERTIES COST 20)
set_tests_properties(
  "judge:Wrong maps, ten-bit normals and extents are rejected, right ones explained"
  "diagnosis:Ten faults planted in three scenes are convicted and named first, by the plane that is wrong"
  "judge:Violations asked beside a looser judgement are those of a judgement of its own"
  "judge:Violations asked beside a looser judgement are its own where there is glass and where masks drop texels"
  "judge:Wrong ways of drawing transparent surfaces are rejected, right ones explained"
  "judge:Row 62: llvmpipe and softpipe differ on a crowded scene, and each pixel of both is explained"
  "gl:Frames of constant colours are llvmpipe's bit for bit, every target format and strategy, glass and all"
  "gl:llvmpipe blends transparent surfaces as we do, in both modes, every preset and strategy, within two codes"
  "gl:Pictures with normal and specular maps are ours in every strategy, under models that read them or do not"
  PROPERTIES COST 10)
