#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace trocar::report {

using Point2 = Eigen::Vector2d;

/// The span of an axis: low < high, both finite.
struct AxisRange {
  double low = 0.0;
  double high = 1.0;
};

/// Range that contains all finite values; widened around a single value; 0..1 without values.
AxisRange range_of(const std::vector<double>& values);

/// A step of 1, 2 or 5 times a power of ten that divides the range into at most `at_most` pieces (>= 1).
double nice_step(const AxisRange& range, int at_most);
/// The range widened to whole steps.
AxisRange nice_range(const AxisRange& range, double step);
/// All multiples of the step inside the range, rising; zero is exactly zero.
std::vector<double> ticks_in(const AxisRange& range, double step);
/// A tick's number with as many decimals as its step needs.
std::string tick_text(double value, double step);

/// The polyline thinned for a picture: of every run of points in one column of `column_width` only the first, lowest,
/// highest and last stay, in order, so that no peak is lost (the M4 aggregation of Jugel et al., VLDB 2014).
std::vector<Point2> thin_out(const std::vector<Point2>& line, double column_width);

/// Places labels of given widths along a line, each as near to its wanted centre as possible without overlap, in the
/// order given (by rising centre), inside low..high as far as they fit. Returns the centres.
std::vector<double> spread_labels(const std::vector<double>& wanted, const std::vector<double>& widths,
                                  const AxisRange& room);

}  // namespace trocar::report
