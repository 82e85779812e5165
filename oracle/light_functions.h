#pragma once

/// The functions of light programs that are computed in f64 and rounded once (docs/arithmetic.md sections 1 and 9),
/// written a second time: libm has no part but sqrt, rounding, frexp and ldexp, whose results are exact or IEEE's.
namespace trueshade::oracle::glsl {

/// Base 2, of a float: NaN below 0, -infinity of 0; and of a positive f64 as section 9 has it.
double log2_64(float x);
double log2_of_positive(double x);
/// 2^t; 0 below -1000, and above 1000 as 2^1000.
double exp2_64(double t);
double atan_64(double x);

float log2(float x);
float log(float x);
float exp2(float x);
float exp(float x);
float pow(float x, float y);
/// NaN beyond 10^6.
float sin(float x);
float cos(float x);
float tan(float x);
float asin(float x);
float acos(float x);
float atan(float x);
float atan2(float y, float x);
float sinh(float x);
float cosh(float x);
float tanh(float x);
float asinh(float x);
float acosh(float x);
float atanh(float x);

}  // namespace trueshade::oracle::glsl
