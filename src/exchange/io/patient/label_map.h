#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/known_structures.h"
#include "core/result.h"
#include "patient_builder/build_patient.h"

namespace trocar::io {

inline constexpr int kMaxLabel = 255;  ///< Largest number of a label in a file.

/// A structure of a segmentation that describes itself (DICOM SEG, RT structure set, .seg.nrrd).
struct DescribedSegment {
  std::string name;                   ///< Its label.
  int number = 0;                     ///< Its number in the file.
  std::string type_in_region;         ///< Its region and property type together: "Liver Neoplasm".
  std::vector<std::string> codes;     ///< Of the type and the region: "SCT:64033007 left".
  std::vector<std::string> meanings;  ///< The same in words: "Kidney left".
};

/// Names that a user gives to the labels of segmentations, and the structures of data_dir().
///   base = "totalsegmentator"     names of numbers that are not in [labels]; also "totalsegmentator:TASK", "btcv" …
///   ignore = [13, 14]             or ignore = ["13", "my_roi"]: labels that are ignored
///   [labels]
///   1 = "liver"                   a number in a file
///   my_roi = "liver_tumor"        the name of a mask file or segment
///   2 = "ignore"
///   "*" = "ignore"                every label without another entry
class LabelMap {
 public:
  /// "totalsegmentator", "totalsegmentator:TASK" (a task of totalsegmentator_tasks.toml), a data set of
  /// dataset_labels.toml, a TOML file, or empty for no names. A name has no point and no slash. Errors: an unusable
  /// file, an unknown name or task (the known ones are listed), an entry that can match nothing (" 5", liver = "5"), no
  /// data.
  static Result<LabelMap> load(const std::string& label_map);

  /// What the values of a file, with the names that they were given, would mean by other schemes that name all of them
  /// and not the same. Entries of the user hold in all. None if the user has named all of them.
  std::vector<patient_builder::OtherReading> other_readings(
      const std::vector<std::pair<int, std::string>>& given) const;

  /// The scheme of the numbers for messages: "TotalSegmentator 2"; empty: none but the user's own.
  const std::string& base_words() const noexcept { return base_words_; }
  /// True for the numbers of TotalSegmentator's task total, also as the base of a file: what is taken unless a user
  /// chooses another scheme.
  bool is_default() const noexcept;
  /// True if the user has chosen what numbers mean: any other scheme, or a file with a base.
  bool is_chosen() const noexcept;
  /// True if the user's own file names the number.
  bool is_own(int number) const { return own_numbers_.contains(number); }
  /// "liver" of "liver_seg", "liver-mask": what a file is named after if it is a known structure; else `stem`.
  std::string name_in_file_name(const std::string& stem) const;
  /// True for the name of a mask file: a structure, also with the number of a case, or a name of the user's map.
  bool is_structure_file(const std::string& stem) const;
  bool is_empty() const noexcept { return by_number_.empty() && !rest_; }
  /// True if the number has its own entry, not only "*".
  bool has_number(int number) const { return by_number_.contains(number); }
  /// Structure of a number in a file, or kIgnoredStructure; empty if it has no name.
  std::optional<std::string> name_of(int number) const;
  /// Structure of a name in a file: the name itself, unless the map has an entry for it.
  std::string name_of(const std::string& name) const;
  /// Structure of a segment: the map's entry for its name or its number, else the first known one of its name (also
  /// with an abbreviated side: "Kidney_L", "Lt Lung"), its type in its region, code and meaning of its type
  /// (structure_codes.toml), those of its region if the type says nothing (tissue, organ); else its name. A name that
  /// is the meaning of its type leaves the choice to the code: "Ventricle" of the heart. A code adds the side or
  /// the level that a name lacks ("Kidney", "Vertebra"), and says which "Bone", "Artery", "Vein" or "Muscle" it is.
  std::string name_of(const DescribedSegment& segment) const;
  /// A warning if a segment's known name and its known code are different tissues, sides or levels; empty otherwise.
  std::string contradiction_in(const DescribedSegment& segment) const;
  /// True for a structure of structures.toml.
  bool is_known(const std::string& name) const { return structures_.find(name) != nullptr; }
  /// True for something that is known, but that no task needs (structure_codes.toml): "tissue", "lymph node".
  bool is_unused(const std::string& name) const;
  const anatomy::KnownStructures& structures() const noexcept { return structures_; }

 private:
  Status read_base(const std::string& base, const std::string& where);
  Status read_codes(const std::filesystem::path& data_folder);
  /// Structure of a code: "SCT:64033007 left" is kidney_left.
  std::optional<std::string> name_of_code(const std::string& code) const;
  /// The structure of a code that says more than the name, and nothing else.
  std::optional<std::string> specified_by_code(const DescribedSegment& segment) const;
  Status read_entry(const std::string& key, std::string name, const std::string& where);
  anatomy::KnownStructures structures_;
  std::string base_;           ///< Name of the scheme; empty: none.
  std::string base_words_;     ///< Its name for messages.
  std::string file_;           ///< The user's TOML file; empty: none.
  std::set<int> own_numbers_;  ///< Named by the user's file.
  std::map<int, std::string> by_number_;
  std::map<std::string, std::string, std::less<>> by_name_;
  std::optional<std::string> rest_;
  /// True for a code that says nothing of the structure: "SCT:85756007", tissue.
  bool is_generic(std::string_view code) const { return generic_codes_.contains(code); }
  std::map<std::string, std::string, std::less<>> by_code_;  ///< "SCT:10200004" -> "liver".
  std::set<std::string, std::less<>> generic_codes_;
  std::set<std::string, std::less<>> unused_;  ///< Plain names.
};

}  // namespace trocar::io
