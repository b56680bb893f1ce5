#pragma once

#include "metrics/metric.h"

namespace trocar::metrics {

// The groups of the metrics; metric.cpp lists them in the order of reports.
MetricGroup end_position_metrics();
MetricGroup curve_distance_metrics();
MetricGroup structure_metrics();
MetricGroup risk_metrics();
MetricGroup tip_path_metrics();
MetricGroup tissue_path_metrics();
MetricGroup smoothness_metrics();
MetricGroup action_metrics();
MetricGroup insertion_metrics();
MetricGroup first_pass_metrics();
MetricGroup bevel_metrics();
MetricGroup force_metrics();
MetricGroup puncture_force_metrics();
MetricGroup transducer_metrics();
MetricGroup contact_metrics();
MetricGroup plane_metrics();
MetricGroup visibility_metrics();
MetricGroup xray_metrics();

}  // namespace trocar::metrics
