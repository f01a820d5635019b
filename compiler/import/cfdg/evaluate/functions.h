#pragma once

#include <map>
#include <string>

namespace graftal::cfdg {

/// Functions of one number; angles are in degrees.
const std::map<std::string, double (*)(double)>& plain_functions();

/// The result of an operator between numbers, as Context Free computes it.
double binary(const std::string& sign, double a, double b);

} // namespace graftal::cfdg
