#include "judge/legal/allows.h"

namespace trueshade::oracle {

namespace {

/// Whether a box that one rule of snapping allows lies in that of the other.
bool grid_within(const Profile& loose, const Profile& tight) {
  if (loose.subpixel_bits == tight.subpixel_bits && loose.snap == tight.snap) return true;
  return loose.snap == SnapRule::unstated && loose.subpixel_bits <= tight.subpixel_bits &&
         tight.snap != SnapRule::toward_zero;
}

bool arithmetic_within(const Arithmetic& loose, const Arithmetic& tight) {
  return loose.roundoff >= tight.roundoff && loose.divide >= tight.divide && loose.inverse_sqrt >= tight.inverse_sqrt &&
         loose.square_root >= tight.square_root && (!loose.exact_pow || tight.exact_pow);
}

bool stores_within(const Profile& loose, const Profile& tight) {
  return loose.unorm_reach >= tight.unorm_reach && loose.srgb_reach >= tight.srgb_reach &&
         (loose.half == HalfStore::either || loose.half == tight.half) &&
         (loose.blend == BlendRule::any_precision || loose.blend == tight.blend) &&
         loose.fetch_error >= tight.fetch_error && (loose.sampling == Sampling{} || loose.sampling == tight.sampling);
}

}  // namespace

bool allows_all_of(const Profile& loose, const Profile& tight) {
  return grid_within(loose, tight) && (loose.fill == FillRule::unstated || loose.fill == tight.fill) &&
         (loose.planes == PlaneForm::homogeneous || loose.planes == tight.planes) &&
         (loose.plane_origin == PlaneOrigin::either || loose.plane_origin == tight.plane_origin) &&
         (!loose.exact_vertices || tight.exact_vertices) && (!loose.exact_planes || tight.exact_planes) &&
         (loose.clips_to_view || !tight.clips_to_view) && loose.least_depth_unit <= tight.least_depth_unit &&
         loose.most_depth_unit >= tight.most_depth_unit && (!loose.max_norm_slope || tight.max_norm_slope) &&
         stores_within(loose, tight) && arithmetic_within(loose.arithmetic, tight.arithmetic);
}

}  // namespace trueshade::oracle
