#include "judge/stages/evidence.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

constexpr StoreRule kIntelCodes{0.5, true, false, HalfStore::either, true};

/// The rules that are known, the likeliest first, as far as the profile leaves them open.
std::vector<StoreRule> other_rules(const StoreRule& stated, const Profile& profile) {
  std::vector<StoreRule> rules;
  const bool open_codes = profile.unorm_reach == 1.0 && profile.blend == BlendRule::any_precision;
  std::vector<HalfStore> halves{stated.half};
  if (profile.half == HalfStore::either)
    for (const HalfStore half : {HalfStore::toward_zero, HalfStore::nearest, HalfStore::through_halves})
      if (half != stated.half) halves.push_back(half);
  for (const HalfStore half : halves) {
    for (const StoreRule& codes :
         {StoreRule{}, StoreRule{0.6}, StoreRule{0.5, true}, kIntelCodes, StoreRule{0.5, false, true}}) {
      StoreRule rule = codes;
      rule.half = half;
      const StoreRule same_codes_rule{rule.code_reach, rule.mesa_codes, rule.sums_in_floats, stated.half,
                                      stated.intel_estimates};
      const bool same_codes = same_codes_rule == stated;
      if (!open_codes && !same_codes) continue;
      if (!(rule == stated)) rules.push_back(rule);
    }
  }
  return rules;
}

}  // namespace

Evidence evidence_of(const StageVerdict& stated, const std::function<StageVerdict(const Profile&)>& judge,
                     const Profile& profile, double least_chance) {
  Evidence best;
  best.tests = aggregate_tests(stated);
  best.rule = stated.rule;
  if (best.least_likely().passes(least_chance) || !stated.passes()) return best;
  best.against = true;
  for (const StoreRule& rule : other_rules(stated.rule, profile)) {
    Profile following_it = profile;
    following_it.likely = rule;
    std::vector<AggregateTest> tests = aggregate_tests(judge(following_it));
    if (least_likely(tests).chance <= best.least_likely().chance) continue;
    best = {std::move(tests), rule, false, true};
    best.against = !best.least_likely().passes(least_chance);
    if (!best.against) return best;
  }
  return best;
}

std::string one_in(double chance) {
  if (!(chance > 0)) return "more than 10^300";
  const double exponent = std::floor(-std::log10(chance));
  return exponent < 4 ? std::to_string(int64_t(1 / chance)) : "10^" + std::to_string(int64_t(exponent));
}

}  // namespace trueshade::oracle
