#include "views/ultrasound/ultrasound_settings.h"

#include <QSettings>
#include <algorithm>
#include <cmath>

#include "ui_kit/parts.h"
#include "ultrasound/live/scan_picture.h"

namespace trocar::trainer {
namespace {

/// Reads or writes all stored settings, so that both use the same names.
template <class Visitor>
void visit(UltrasoundSettings& s, const Visitor& field) {
  field("depth_mm", s.acquisition.depth_mm);
  field("frequency_mhz", s.acquisition.frequency_mhz);
  field("is_harmonic", s.acquisition.is_harmonic);
  field("focus_mm", s.acquisition.focus_mm);
  field("gain_db", s.display.gain_db);
  for (std::size_t n = 0; n < s.display.tgc_db.size(); ++n)
    field(QStringLiteral("tgc_db/%1").arg(n + 1).toLatin1().constData(), s.display.tgc_db[n]);
  field("dynamic_range_db", s.display.dynamic_range_db);
  field("persistence", s.display.persistence);
  field("is_marker_left", s.display.is_mirrored);
  field("is_rolling", s.is_rolling);
  field("is_gain_automatic", s.is_gain_automatic);
  field("doppler/scale_cm_per_s", s.doppler.scale_cm_per_s);
  field("doppler/gain_db", s.doppler.gain_db);
  field("doppler/baseline", s.doppler.baseline);
  field("doppler/is_inverted", s.doppler.is_inverted);
  field("guide/is_shown", s.guide.is_shown);
  field("guide/angle_deg", s.guide.angle_deg);
  field("guide/is_on_marked_side", s.guide.is_on_marked_side);
}

QString group(const ultrasound::Transducer& transducer) {
  return QStringLiteral("ultrasound/") + to_qt(transducer.name);
}

}  // namespace

UltrasoundSettings default_settings(const ultrasound::Transducer& transducer) {
  UltrasoundSettings settings;
  settings.acquisition = ultrasound::default_acquisition(transducer);
  settings.doppler.frequency_mhz = std::max(transducer.lowest_mhz, 0.8 * transducer.frequency_mhz);
  return settings;
}

UltrasoundSettings within_ranges(const UltrasoundSettings& settings, const ultrasound::Transducer& transducer) {
  ultrasound::ScanRequest request;
  request.acquisition = settings.acquisition;
  request.display = settings.display;
  request.doppler = settings.doppler;
  request = trocar::ultrasound::within_ranges(request, transducer);
  UltrasoundSettings held = settings;
  held.acquisition = request.acquisition;
  held.display = request.display;
  held.doppler = request.doppler;
  const double angle_deg = settings.guide.angle_deg;
  held.guide.angle_deg = std::isfinite(angle_deg) ? std::clamp(angle_deg, 10.0, 80.0) : NeedleGuide().angle_deg;
  return held;
}

UltrasoundSettings load_settings(const ultrasound::Transducer& transducer) {
  UltrasoundSettings settings = default_settings(transducer);
  QSettings store;
  store.beginGroup(group(transducer));
  visit(settings, [&](const char* name, auto& value) {
    const QVariant kept = store.value(QString::fromLatin1(name));
    if (kept.canConvert<std::decay_t<decltype(value)>>()) value = kept.value<std::decay_t<decltype(value)>>();
  });
  const auto map = ultrasound::parse_gray_map(to_std(store.value(QStringLiteral("gray_map")).toString()));
  if (map) settings.display.gray_map = *map;
  return within_ranges(settings, transducer);
}

void save_settings(const ultrasound::Transducer& transducer, const UltrasoundSettings& settings) {
  QSettings store;
  store.beginGroup(group(transducer));
  UltrasoundSettings kept = settings;
  visit(kept, [&](const char* name, auto& value) { store.setValue(QString::fromLatin1(name), value); });
  store.setValue(QStringLiteral("gray_map"), to_qt(ultrasound::name_of(settings.display.gray_map)));
}

}  // namespace trocar::trainer
