# Seconds of CPU time of the slowest tests, so that ctest starts with them before it has times of its own: one that is started last
# keeps one core busy while the others wait. A name that no test has any more is ignored.
set_tests_properties("shading:every built-in scene has one hash over pairs of all ways to draw it" PROPERTIES COST 32)
set_tests_properties(
  "judge:llvmpipe's own wrong maps, ten-bit normals and extents are rejected, under its profile too"
  "judge:Wrong maps, ten-bit normals and extents are rejected, right ones explained"
  "judge:llvmpipe's own wrong frames are rejected, under its profile too"
  "gl:llvmpipe draws every preset in every strategy as we do, within two codes of a target that rounds light by light"
  "judge:Maps, ten-bit normals, mixed extents and glass by llvmpipe are explained under every preset and strategy"
  "judge:What llvmpipe draws is explained under every preset and strategy, by its profile and by any GPU's"
  "judge:Wrong renderers are rejected wherever they leave the legal sets"
  "judge:llvmpipe's own wrong glass is rejected, under its profile too"
  "raster:A million pairs of triangles hit no pixel twice along their edge and miss none"
  PROPERTIES COST 20)
set_tests_properties(
  "judge:Wrong ways of drawing transparent surfaces are rejected, right ones explained"
  "judge:Our own frames are explained under every preset and strategy"
  "judge:Row 62: llvmpipe and softpipe differ on a crowded scene, and each pixel of both is explained"
  "gl:Every OpenGL design draws textured materials, and spot lights in their cones"
  "gl:Frames of constant colours are llvmpipe's bit for bit, every target format and strategy, glass and all"
  "gl:llvmpipe blends transparent surfaces as we do, in both modes, every preset and strategy, within two codes"
  "gl:llvmpipe draws every scene and preset as we do, off edges, within a code"
  "gl:Pictures with normal and specular maps are ours in every strategy, under models that read them or do not"
  "raster:All built-in scenes show what Embree's rays hit at 800 x 800, away from edges and depth ties"
  PROPERTIES COST 10)
