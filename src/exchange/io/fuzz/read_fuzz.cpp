// Changes small valid files at random and reads them (scripts/fuzz readers): io_fuzz [INPUTS [SEED [NAME]]], 1,000,000
// inputs by default, of all kinds or of those whose name contains NAME ("jp": JPEG and JPEG 2000). Each reader must
// return, within 10 s and with less than 512 MiB above what the program had before. Readers run in child processes;
// what ends one is kept in the working folder as fuzz-input.*, with the reader's name. Exit status 1 if there was one.
#include <fmt/format.h>
#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>
#include <gdcmSequenceOfFragments.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <functional>
#include <random>
#include <stdexcept>

#include "core/files/folders.h"
#include "core/text.h"
#include "dicom/testing/segmentation_writer.h"
#include "io/image/image_file.h"
#include "io/image/testing/hand_made_nifti.h"
#include "io/markups_file.h"
#include "io/mesh_file.h"
#include "io/patient/label_sources.h"
#include "io/sequence/plus_config.h"
#include "io/sequence/sequence_file.h"
#include "io/sequence/transform_file.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

constexpr std::size_t kInputsOfAChild = 2'000;
constexpr long kMostMegabytes = 512;
constexpr unsigned kMostSeconds = 10;

/// A reader and the file that it gets, valid before it is changed.
struct Target {
  std::string name;  ///< Of the file.
  std::string bytes;
  std::function<void(const fs::path&)> read;
};

template <class Read>
std::function<void(const fs::path&)> without_result(Read read) {
  return [read](const fs::path& path) { (void)read(path); };
}

const auto kReadCt = without_result([](const fs::path& path) { return read_ct_scan(path); });
const auto kReadFolder = without_result([](const fs::path& path) { return read_ct_scan(path.parent_path()); });
const auto kReadLabels =
    without_result([](const fs::path& path) { return read_label_sources({path}, "totalsegmentator"); });

std::string written(const fs::path& folder, const std::string& name, const auto& write) {
  write(folder / name);
  return testing::read_bytes(folder / name);
}

void add_images(const fs::path& folder, std::vector<Target>& targets) {
  const auto ct = testing::numbered_grid<std::int16_t>(testing::oblique_geometry());
  const auto labels = testing::numbered_grid<std::uint8_t>(testing::oblique_geometry());
  for (const char* name : {"a.nii", "a.nii.gz", "a.nrrd", "a.mha"}) {
    targets.push_back(
        {name, written(folder, name, [&](const fs::path& path) { (void)write_image(ct, path); }), kReadCt});
    targets.push_back(
        {name, written(folder, name, [&](const fs::path& path) { (void)write_image(labels, path); }), kReadLabels});
  }
  targets.push_back({"b.nii", testing::small_nifti(4, testing::numbers(12)).bytes, kReadCt});
  const std::string place = "space: LPS\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (1,2,3)\n";
  targets.push_back({"b.nrrd",
                     "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\n" + place +
                         "encoding: raw\nSegment0_Name:=liver\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n\n" +
                         std::string(12, '\1'),
                     kReadLabels});
  targets.push_back({"c.nrrd",
                     "NRRD0005\ntype: short\ndimension: 3\nsizes: 3 2 2\n" + place +
                         "endian: little\nencoding: ascii\n\n1 2 3 4 5 6 7 8 9 10 11 12\n",
                     kReadCt});
  targets.push_back(
      {"b.mha",
       "ObjectType = Image\nNDims = 3\nBinaryData = True\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 1 2 3\n"
       "ElementSpacing = 1 2 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
           std::string(12, '\1'),
       kReadCt});
}

/// An 8-bit image packed by a lossy process of JPEG.
std::string lossy_stream(const testing::CtSeries& series) {
  std::string pixels;
  for (int n = 0; n < series.columns * series.rows; ++n) pixels += static_cast<char>(n * 3 % 128);
  gdcm::SmartPointer<gdcm::Image> image = new gdcm::Image;
  image->SetNumberOfDimensions(2);
  image->SetDimension(0, static_cast<unsigned>(series.columns));
  image->SetDimension(1, static_cast<unsigned>(series.rows));
  image->SetPixelFormat(gdcm::PixelFormat(1, 8, 8, 7, 0));
  image->SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  image->SetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
  gdcm::DataElement element(gdcm::Tag(0x7fe0, 0x0010));
  element.SetByteValue(pixels.data(), gdcm::VL(static_cast<std::uint32_t>(pixels.size())));
  image->SetDataElement(element);
  gdcm::ImageChangeTransferSyntax change;
  change.SetTransferSyntax(gdcm::TransferSyntax::JPEGBaselineProcess1);
  change.SetInput(*image);
  if (!change.Change()) throw std::runtime_error("cannot compress as lossy JPEG");
  const gdcm::ByteValue* value =
      change.GetOutput().GetDataElement().GetSequenceOfFragments()->GetFragment(0).GetByteValue();
  return {value->GetPointer(), value->GetLength()};
}

/// Slices of 8 bits, with pixels of a lossy JPEG.
void add_lossy(const fs::path& folder, std::vector<Target>& targets) {
  const testing::CtSeries series;
  const std::string stream = lossy_stream(series);
  const auto item = [](std::uint32_t tag, const std::string& value) {
    return testing::little_endian(0xfffe, 2) + testing::little_endian(tag, 2) +
           testing::little_endian(static_cast<std::uint32_t>(value.size()), 4) + value;
  };
  fs::create_directory(folder / "jpeg-lossy");
  for (int n = 0; n < 3; ++n) {
    const fs::path file = folder / "jpeg-lossy" / fmt::format("slice{}", n);
    const std::string pixels = testing::little_endian(0x7fe0, 2) + testing::little_endian(0x0010, 2) + "OB" +
                               std::string(2, '\0') + testing::little_endian(0xffffffff, 4) + item(0xe000, {}) +
                               item(0xe000, stream) + item(0xe0dd, {});
    const std::string elements =
        testing::dicom_element(0x0008, 0x0060, "CS", "CT") + testing::dicom_element(0x0020, 0x000e, "UI", "1.2.3") +
        testing::dicom_point(0x0020, 0x0032, Vec3(0, 0, 2.0 * n)) +
        testing::dicom_decimals(0x0020, 0x0037, {1, 0, 0, 0, 1, 0}) + testing::dicom_short(0x0028, 0x0002, 1) +
        testing::dicom_element(0x0028, 0x0004, "CS", "MONOCHROME2") +
        testing::dicom_short(0x0028, 0x0010, series.rows) + testing::dicom_short(0x0028, 0x0011, series.columns) +
        testing::dicom_decimals(0x0028, 0x0030, {1, 1}) + testing::dicom_short(0x0028, 0x0100, 8) +
        testing::dicom_short(0x0028, 0x0101, 8) + testing::dicom_short(0x0028, 0x0102, 7) +
        testing::dicom_short(0x0028, 0x0103, 0) + pixels;
    testing::write_bytes(file, testing::dicom_file(elements, "1.2.840.10008.1.2.4.50"));
  }
  if (const auto scan = read_ct_scan(folder / "jpeg-lossy"); !scan) throw std::runtime_error(scan.error().text());
  targets.push_back({"jpeg-lossy/slice1", testing::read_bytes(folder / "jpeg-lossy/slice1"), kReadFolder});
}

/// The slices of "ct" with compressed pixels, in a folder of this name.
void add_compressed(const fs::path& folder, const std::string& name, gdcm::TransferSyntax::TSType syntax,
                    std::vector<Target>& targets) {
  fs::create_directory(folder / name);
  for (int n = 0; n < 3; ++n) {
    const std::string slice = fmt::format("slice{}", n);
    gdcm::ImageReader reader;
    reader.SetFileName((folder / "ct" / slice).c_str());
    gdcm::ImageChangeTransferSyntax change;
    change.SetTransferSyntax(syntax);
    gdcm::ImageWriter writer;
    const bool is_read = reader.Read();
    change.SetInput(reader.GetImage());
    if (!is_read || !change.Change()) throw std::runtime_error("cannot compress as " + name);
    writer.SetFile(reader.GetFile());
    writer.SetImage(change.GetOutput());
    writer.SetFileName((folder / name / slice).c_str());
    if (!writer.Write()) throw std::runtime_error("cannot write " + name);
  }
  if (const auto scan = read_ct_scan(folder / name); !scan) throw std::runtime_error(name + scan.error().text());
  targets.push_back({name + "/slice1", testing::read_bytes(folder / name / "slice1"), kReadFolder});
}

void add_dicom(const fs::path& folder, std::vector<Target>& targets) {
  testing::write_slices(folder / "ct", {}, {Vec3(0, 0, 0), Vec3(0, 0, 2), Vec3(0, 0, 4)},
                        [](const Vec3& p_P) { return p_P.sum(); });
  targets.push_back({"ct/slice1", testing::read_bytes(folder / "ct/slice1"), kReadFolder});
  using enum gdcm::TransferSyntax::TSType;
  add_compressed(folder, "rle", RLELossless, targets);
  add_compressed(folder, "jpeg", JPEGLosslessProcess14_1, targets);
  add_compressed(folder, "jpeg-ls", JPEGLSLossless, targets);
  add_compressed(folder, "jpeg-2000", JPEG2000Lossless, targets);
  add_lossy(folder, targets);
  testing::TestSeg seg;
  seg.segments = {testing::segment_item(1, "liver"), testing::segment_item(2, "spleen")};
  for (int n = 0; n < 3; ++n)
    seg.frames.push_back({1 + n % 2, Vec3(0, 0, 2.0 * n), [](int i, int j) { return i > 2 && j > 1 ? 1 : 0; }});
  const auto read_object = [](const fs::path& path) {
    std::vector<std::string> warnings;
    const dicom::CtReference reference{testing::oblique_geometry(), "1.2.3", "1.2.9", {}};
    (void)read_label_sources({path}, "totalsegmentator", reference, warnings);
  };
  targets.push_back({"seg", testing::dicom_file(testing::seg_elements(seg)), read_object});
  const std::vector<Vec3> square{{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}};
  targets.push_back({"rt",
                     testing::dicom_file(testing::structure_set_elements({{"liver", {{"CLOSED_PLANAR", square}}}})),
                     read_object});
}

void add_others(std::vector<Target>& targets) {
  targets.push_back({"a.mrk.json",
                     R"({"markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "controlPoints": [{"label": "a", )"
                     R"("position": [1, 2, 3]}]}, {"type": "Line", "controlPoints": [{"position": [1, 2, 3]}, )"
                     R"({"position": [4, 5, 6]}]}]})",
                     [](const fs::path& path) {
                       (void)read_landmarks(path);
                       (void)read_paths(path);
                     }});
  targets.push_back({"a.tfm",
                     "#Insight Transform File V1.0\n#Transform 0\nTransform: AffineTransform_double_3_3\n"
                     "Parameters: 1 0 0 0 1 0 0 0 1 1 2 3\nFixedParameters: 0 0 0\n",
                     without_result([](const fs::path& path) { return read_transform(path); })});
  targets.push_back(
      {"a.igs.mha",
       "ObjectType = Image\nNDims = 3\nDimSize = 4 4 2\nElementType = MET_UCHAR\nElementSpacing = 1 1 1\n"
       "UltrasoundImageOrientation = MFA\nSeq_Frame0000_ImageToReferenceTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
       "Seq_Frame0000_ImageToReferenceTransformStatus = OK\nSeq_Frame0000_Timestamp = 0\n"
       "Seq_Frame0001_ImageToReferenceTransform = 1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 1\n"
       "Seq_Frame0001_ImageToReferenceTransformStatus = OK\nSeq_Frame0001_Timestamp = 1\nElementDataFile = LOCAL\n" +
           std::string(32, '\7'),
       without_result([](const fs::path& path) { return read_sequence(path); })});
  targets.push_back({"a.xml",
                     "<PlusConfiguration><CoordinateDefinitions><Transform From=\"Image\" To=\"Probe\" "
                     "Matrix=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\"/></CoordinateDefinitions></PlusConfiguration>",
                     without_result([](const fs::path& path) { return read_plus_config(path); })});
  targets.push_back({"a.stl",
                     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                     "endfacet\nendsolid a\n",
                     without_result([](const fs::path& path) { return read_mesh(path); })});
}

/// Random changes of bytes, ranges and numbers.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::string change(std::string bytes) {
    for (std::size_t n = 1 + below(6); n > 0; --n) change_once(bytes);
    return bytes;
  }
  std::size_t below(std::size_t count) { return count == 0 ? 0 : static_cast<std::size_t>(random_() % count); }

 private:
  void change_once(std::string& bytes) {
    if (bytes.empty()) bytes.push_back('x');
    // Headers come first, and decide what is read.
    const std::size_t at = below(below(2) == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 800));
    switch (below(8)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
        break;
      case 1:
        bytes[at] = static_cast<char>(random_());
        break;
      case 2:
        overwrite_number(bytes, at);
        break;
      case 3:
        bytes.erase(at, 1 + below(16));
        break;
      case 4:
        bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(64)));
        break;
      case 5:
        bytes.resize(at + 1);
        break;
      case 6:
        bytes.insert(at, 1 + below(5'000), static_cast<char>('0' + below(10)));
        break;
      default:
        replace_digits(bytes, at);
    }
  }

  void overwrite_number(std::string& bytes, std::size_t at) {
    static constexpr std::array<std::uint64_t, 10> kNumbers{
        0, 1, 0x7f, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0xffffffff, 0x7ff0000000000000, 0xffffffffffffffff};
    std::uint64_t number = kNumbers[below(kNumbers.size())];
    for (std::size_t n = 0, size = std::size_t{1} << below(4); n < size && at + n < bytes.size(); ++n, number >>= 8)
      bytes[at + n] = static_cast<char>(number & 0xff);
  }

  /// Another number in a text.
  void replace_digits(std::string& bytes, std::size_t at) {
    static const std::array<std::string, 12> kTexts{
        "-3", "0",          "1e308", "nan",    "inf", "99999999999999999999",
        "-1", "4294967296", "65536", "1e-320", "3.5", "2147483647"};
    const std::size_t begin = bytes.find_first_of("0123456789", at);
    if (begin == std::string::npos) return;
    const std::size_t end = std::min(bytes.find_first_not_of("0123456789.", begin), bytes.size());
    bytes.replace(begin, end - begin, kTexts[below(kTexts.size())]);
  }

  std::mt19937_64 random_;
};

long peak_megabytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

/// The child: reads changed files, each of which lies in the folder while it is read.
[[noreturn]] void read_changed(const std::vector<Target>& targets, const fs::path& folder, std::uint64_t seed,
                               std::size_t count) {
  Mutator mutator(seed);
  const long before_mb = peak_megabytes();
  for (std::size_t n = 0; n < count; ++n) {
    const Target& target = targets[mutator.below(targets.size())];
    const fs::path path = folder / target.name;
    testing::write_bytes(path, mutator.change(target.bytes));
    std::ofstream(folder / "current") << target.name;
    ::alarm(kMostSeconds);
    target.read(path);
    ::alarm(0);
    if (peak_megabytes() > before_mb + kMostMegabytes) ::_exit(3);
    testing::write_bytes(path, target.bytes);  // a slice belongs to the series of the next input
  }
  ::_exit(0);
}

/// True if the child has read all of its inputs.
bool run_child(const std::vector<Target>& targets, const fs::path& folder, std::uint64_t seed, std::size_t count) {
  const pid_t child = ::fork();
  if (child == 0) read_changed(targets, folder, seed, count);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  const std::string name = testing::read_bytes(folder / "current");
  const std::string kept = fmt::format("fuzz-input.{}.{}", seed, fs::path(name).filename().string());
  std::error_code error;
  fs::copy_file(folder / name, kept, fs::copy_options::overwrite_existing, error);
  const std::string why = WIFSIGNALED(status)        ? WTERMSIG(status) == SIGALRM ? "took longer than 10 s"
                                                                                   : fmt::format("signal {}", WTERMSIG(status))
                                 : WEXITSTATUS(status) == 3 ? "took more than 512 MiB"
                                                     : fmt::format("status {}", WEXITSTATUS(status));
  fmt::print(stderr, "{}: {}, kept as {}\n", name, why, kept);
  return false;
}

int fuzz(std::size_t count, std::uint64_t seed, const std::string& name) {
  const TemporaryFolder folder;
  std::vector<Target> targets;
  add_images(folder.path(), targets);
  add_dicom(folder.path(), targets);
  add_others(targets);
  std::erase_if(targets, [&](const Target& target) { return target.name.find(name) == std::string::npos; });
  if (targets.empty()) throw std::runtime_error("no kind of file has this name");
  std::size_t failed = 0;
  for (std::size_t done = 0; done < count; done += kInputsOfAChild) {
    failed += run_child(targets, folder.path(), seed + done, std::min(kInputsOfAChild, count - done)) ? 0 : 1;
    if (done / kInputsOfAChild % 10 == 0) fmt::print(stderr, "\r{} inputs, {} ended a reader", done, failed);
  }
  fmt::print(stderr, "\r{} inputs of {} kinds, {} ended a reader\n", count, targets.size(), failed);
  return failed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace trocar::io

int main(int count, char** arguments) {
  const auto number = [&](int n, std::uint64_t otherwise) {
    return count > n ? trocar::parse_number<std::uint64_t>(arguments[n]).value_or(otherwise) : otherwise;
  };
  return trocar::io::fuzz(number(1, 1'000'000), number(2, 1), count > 3 ? arguments[3] : "");
}
