#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar::anatomy {

/// Resistance of tissue as a function of HU, for unlabelled tissue (paper B, eqs. 1 to 5; physics.md B1 to B4).
struct HuLaw {
  double stiffness_n_per_mm = 1.0;         ///< Stiffness k before the proxy moves. Range 0.01..50.
  double normal_n = 0.0;                   ///< T_N: threshold along the gradient, into denser tissue. Range 0..200.
  double tangential_n = 0.0;               ///< T_T: threshold across the gradient. Range 0..50.
  double resistance_n = 0.0;               ///< R0: force that the tip needs to move at all. Range 0..50.
  double viscosity_ns_per_mm = 0.0;        ///< c: R = R0 + c|v|. Range 0..1.
  double shaft_n_per_mm = 0.0;             ///< Dry friction per mm of inserted shaft. Range 0..0.1.
  double shaft_viscosity_ns_per_mm = 0.0;  ///< nu of the friction law F1. Range 0..1.
  double young_kpa = 10.0;                 ///< Young's modulus under slow load. Range 0..100000.
};

/// Transfer functions over HU, piecewise linear between knots, constant beyond the outermost. Fixed size: read in the
/// tick.
struct HuTransfer {
  static constexpr std::size_t kMaxKnots = 24;
  std::array<double, kMaxKnots> hu{};  ///< Strictly rising.
  std::array<HuLaw, kMaxKnots> laws{};
  std::size_t knot_count = 0;  ///< 0: no transfer functions; the proxy models refuse the table.

  double gradient_scale_mm = 1.5;         ///< Half distance of the central differences. Range 0.2..5.
  double gradient_none_hu_per_mm = 15.0;  ///< Gradient below which there is no border, only viscosity. Range 0..500.
  /// Gradient from which the border has full effect. Range above the former..1000.
  double gradient_full_hu_per_mm = 30.0;

  /// Real-time safe; NaN reads as the first knot.
  HuLaw at(double hu_value) const noexcept;
};

/// A membrane or organ surface that the tip indents before it punctures it (paper A, pre-puncture force; physics.md
/// P1).
struct LayerParams {
  std::string name;                  ///< As in puncture events: skin, muscle, liver_capsule, vessel, bowel, pleura …
  double stiffness_n_per_mm = 0.0;   ///< k. Range 0.001..50.
  double viscosity_ns_per_mm = 0.0;  ///< nu of the loading law. Range 0..1.
  double delta_x_mm = 0.1;           ///< Displacement after which a Voigt element is added. Range 0.01..20.
  double puncture_force_n =
      std::numeric_limits<double>::infinity();  ///< Puncture force. Range 0.01..100; infinite: never (bone).
  bool is_wall = false;  ///< Volume proxy: must be pierced at a label's border, because the CT does not show it.
  /// Outer diameter of the needle that the puncture force is for; 0: that of the table. Range 0..5.
  double for_diameter_mm = 0.0;
  /// The layer spreads the load of the tip over this distance around it onto the tissue below, which gives way
  /// (physics.md P6). 0: the layer is held from the side and the tissue below does not matter. Range 0..10.
  double load_spread_mm = 0.0;
  /// Young's modulus that soft tissue below the layer has at least under a needle's load (P6). Range 0..1000.
  double pressed_young_kpa = 0.0;
};

/// How puncture and cutting forces depend on the needle (physics.md P7). The default is no dependence.
struct NeedleSizeLaw {
  double diameter_mm = 0.0;    ///< Outer diameter of the needle that the table's forces are for; 0: any. Range 0.3..5.
  double bevel_deg = 20.0;     ///< Bevel of that needle, between face and axis. Range 5..70.
  double tearing = 61.0;       ///< Share of the force that tears the tissue; grows with the diameter. Range 0..100.
  double spreading = 18.0;     ///< Share that spreads the tissue; grows with the diameter squared. Range 0..100.
  double face_friction = 0.0;  ///< Coefficient of friction between the bevel's face and the tissue. Range 0..0.35.
  double bevel_power = 0.0;    ///< The share that tears grows with this power of the bevel's sine. Range 0..1.
};

/// Friction that does not belong to one tissue.
struct FrictionLaw {
  double tip = 2.0;  ///< Coefficient of friction of a needle's tip on unpierced skin (physics.md V2). Range 0..5.
  /// The viscous friction of the shaft grows with speed up to this; infinite: paper A's law (F1). Range 0.1..1000.
  double grows_to_mm_per_s = std::numeric_limits<double>::infinity();
};

/// Paper A's path constraint (physics.md C3, C4) with these numbers, instead of the bending shaft in the tissue.
struct PathConstraintLaw {
  bool is_given = false;
  double force_n = 3.0;      ///< m_0. Range 0..20. A device may render less.
  double torque_nmm = 80.0;  ///< n_0. Range 0..500.
};

/// Friction and cutting of shaft and tip inside a tissue (paper A; physics.md F1, C1).
struct TissueParams {
  std::string name;                   ///< "liver", "adipose", "bone" …; index 0 is "air".
  double viscosity_ns_per_mm = 0.0;   ///< nu of the friction law. Range 0..1.
  double friction_mu = 0.0;           ///< Coefficient of kinetic friction mu. Range 0..2.
  double roughness_n = 0.0;           ///< delta: the friction fluctuates within +-delta*mu. Range 0..5.
  double stick_n_per_mm = 0.0;        ///< Karnopp holding force per mm of inserted shaft. Range 0..0.1.
  double cutting_n = 0.0;             ///< F_c while fresh tissue is cut. Range 0..10.
  std::optional<std::uint8_t> layer;  ///< Index into TissueTable::layers of the surface to pierce before this tissue.
  double young_kpa = 10.0;            ///< Young's modulus under slow load: bed of the shaft, palpation. Range 0..1e6.
};

/// Source of a number.
struct Provenance {
  std::string source;               ///< "paper A, Table 1", a DOI, or "assumed".
  std::optional<double> low, high;  ///< Range of an assumed or measured value.
};

/// Mechanical properties of all tissues (data/tissues.toml), after a profile and overrides.
struct TissueTable {
  std::string profile;  ///< "paper-a", "tented" …
  std::vector<LayerParams> layers;
  std::vector<TissueParams> tissues;             ///< [0] is air: all zero.
  std::map<std::string, Provenance> provenance;  ///< "tissues.liver.friction_mu", "layers.skin.delta_x_mm" -> source.
  double skin_thickness_mm = 2.0;  ///< The skin is a shell of the distance field, not voxels. Range 0.5..6.
  std::uint8_t skin = 0;           ///< Tissue index of the skin.
  HuTransfer transfer;             ///< Transfer functions of unlabelled tissue, over HU.
  NeedleSizeLaw needle_size;
  PathConstraintLaw path_constraint;
  FrictionLaw friction;
  std::string origin;  ///< Where a table comes from that is not the program's: "fitted to ..."; at most 200 bytes.

  std::optional<std::uint8_t> find_tissue(std::string_view name) const noexcept;
  std::optional<std::uint8_t> find_layer(std::string_view name) const noexcept;
  /// The table as TOML text that load_tissue_table reads back to the same values; stored in every session.
  std::string to_toml() const;
};

/// Reads a tissue file and applies one of its profiles ("paper-a" when empty). A table that to_toml wrote already
/// contains its profile. Errors name the line: a number out of range or without source, an unknown key, layer or
/// profile.
Result<TissueTable> load_tissue_table(const std::filesystem::path& path, std::string_view profile = {});
Result<TissueTable> parse_tissue_table(std::string_view toml_text, const std::string& name,
                                       std::string_view profile = {});
/// Profiles of a tissue file.
Result<std::vector<std::string>> tissue_profiles(const std::filesystem::path& path);

/// Applies one override "liver.k=0.5": TISSUE.KEY=VALUE or LAYER.KEY=VALUE, KEY a field name or its short form (k, nu,
/// mu, dx, delta, stick, fc, fp, young, spread, diameter); fp may be "never"; skin.thickness_mm is the shell's;
/// LAYER.wall is 0 or 1; transfer.gradient_scale_mm, _none_hu_per_mm and _full_hu_per_mm (scale, none, full) are the
/// transfer functions'; path_constraint.m0 and .n0 select paper A's path constraint; friction.tip and .grows_to
/// (or "never") are the friction's. A layer's key given on a tissue changes
/// that tissue's layer. nu given on the first tissue that carries a layer changes the layer too: paper A's table has
/// one nu for both laws. tissues.NAME.KEY and layers.NAME.KEY mean that row alone. transfer.tn_factor=1.2 (k, tn, tt,
/// r0, c, shaft, nu, young) multiplies the whole curve over HU as it stands by 0.1..10, each value kept in its field's
/// range. Out of range or unknown: exit status 2, the table is unchanged.
Status apply_override(TissueTable& table, std::string_view assignment);

}  // namespace trocar::anatomy
