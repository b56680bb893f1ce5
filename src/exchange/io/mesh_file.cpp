#include "io/mesh_file.h"

#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkSTLWriter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "core/files/input_file.h"
#include "core/files/output_file.h"
#include "core/text.h"
#include "io/image/detail/inflate_input.h"
#include "io/image/detail/itk_image.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kExportSurfaceAgain = "export the surface again";
constexpr std::uint64_t kMaxVertices = 50'000'000;  ///< Assumed: far above any organ surface.

enum class MeshFormat { kVtp, kStl };

Result<MeshFormat> find_mesh_format(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = ascii::to_lower(c);
  if (ending == ".vtp") return MeshFormat::kVtp;
  if (ending == ".stl") return MeshFormat::kStl;
  return fail("not a surface file of a known kind", path.string(), "give a .vtp or .stl file");
}

/// VTK's STL reader trusts the triangle count of a binary file.
Status check_stl(const std::string& bytes, const std::string& where) {
  if (bytes.starts_with("solid") && bytes.find("facet") != std::string::npos) return {};
  if (bytes.size() < 84) return fail("not an STL surface", where, kExportSurfaceAgain);
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  if (bytes.size() >= 84 + std::uint64_t{50} * count) return {};
  return fail("the surface ends before its last triangle", where, kExportSurfaceAgain);
}

/// VTK allocates the declared size of a .vtp file. Each point and polygon takes more than one byte, even compressed.
Status check_vtp(std::string_view text, const std::string& where) {
  if (text.find("<VTKFile") == std::string_view::npos || text.find("PolyData") == std::string_view::npos)
    return fail("not a VTK surface", where, kExportSurfaceAgain);
  if (text.find("<!DOCTYPE") != std::string_view::npos || text.find("<!ENTITY") != std::string_view::npos)
    return fail("has a document type of its own", where, kExportSurfaceAgain);
  constexpr std::string_view kNumberOf = "NumberOf";
  for (auto at = text.find(kNumberOf); at != std::string_view::npos; at = text.find(kNumberOf, at + 1)) {
    const auto quote = text.find_first_of("\"'<>", at);
    if (quote == std::string_view::npos || text[quote] == '<' || text[quote] == '>') continue;
    const auto count = find_leading_number<std::uint64_t>(text.substr(quote + 1));
    if (count && (count->value > kMaxVertices || count->value > text.size() * detail::kMaxDeflateRatio))
      return fail("the surface declares more points than its file can hold", where, kExportSurfaceAgain);
  }
  return {};
}

Status check_bytes(const std::string& bytes, MeshFormat format, const std::string& where) {
  switch (format) {
    case MeshFormat::kStl:
      return check_stl(bytes, where);
    case MeshFormat::kVtp:
      return check_vtp(bytes, where);
  }
  return {};
}

template <class Reader>
bool run_reader(Reader& reader) {
  reader.Update();
  return reader.GetErrorCode() == 0 && reader.GetOutput() != nullptr;
}

Result<TriangleMesh> mesh_of(vtkPolyData& data, const std::string& where) {
  TriangleMesh mesh;
  mesh.vertices.reserve(static_cast<std::size_t>(data.GetNumberOfPoints()));
  for (vtkIdType n = 0; n < data.GetNumberOfPoints(); ++n) {
    const Vec3f vertex = Vec3(data.GetPoint(n)).cast<float>();
    if (!vertex.allFinite()) return fail("the surface has a vertex that is not a number", where, kExportSurfaceAgain);
    mesh.vertices.push_back(vertex);
  }
  vtkNew<vtkIdList> cell;
  vtkCellArray& polygons = *data.GetPolys();
  for (polygons.InitTraversal(); polygons.GetNextCell(cell) != 0;) {
    for (vtkIdType n = 0; n < cell->GetNumberOfIds(); ++n)
      if (cell->GetId(n) < 0 || cell->GetId(n) >= data.GetNumberOfPoints())
        return fail("the surface names a vertex that it does not have", where, kExportSurfaceAgain);
    // A planar polygon becomes a fan of triangles.
    const auto id = [&](vtkIdType n) { return static_cast<std::uint32_t>(cell->GetId(n)); };
    for (vtkIdType n = 2; n < cell->GetNumberOfIds(); ++n) mesh.triangles.push_back({id(0), id(n - 1), id(n)});
  }
  if (mesh.triangles.empty()) return fail("the surface has no triangle", where, kExportSurfaceAgain);
  return mesh;
}

Result<TriangleMesh> read_mesh_throwing(const InputFile& file, const std::string& bytes, MeshFormat format) {
  const std::string where = file.path().string();
  const auto bad = [&] { return fail("damaged or not a surface", where, kExportSurfaceAgain); };
  switch (format) {
    case MeshFormat::kStl: {
      vtkNew<vtkSTLReader> reader;
      reader->SetFileName(file.pinned_path().c_str());
      if (!run_reader(*reader)) return bad();
      return mesh_of(*reader->GetOutput(), where);
    }
    case MeshFormat::kVtp: {
      vtkNew<vtkXMLPolyDataReader> reader;
      reader->ReadFromInputStringOn();
      reader->SetInputString(bytes);
      if (!run_reader(*reader)) return bad();
      return mesh_of(*reader->GetOutput(), where);
    }
  }
  return bad();
}

vtkNew<vtkPolyData> poly_data_of(const TriangleMesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n)
    points->SetPoint(static_cast<vtkIdType>(n), mesh.vertices[n].x(), mesh.vertices[n].y(), mesh.vertices[n].z());
  vtkNew<vtkCellArray> cells;
  for (const auto& t : mesh.triangles) {
    const std::array<vtkIdType, 3> ids{t[0], t[1], t[2]};
    cells->InsertNextCell(3, ids.data());
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  return data;
}

template <class Writer>
bool run_writer(Writer& writer, vtkPolyData& data, const fs::path& path) {
  writer.SetFileName(path.c_str());
  writer.SetInputData(&data);
  return writer.Write() == 1 && writer.GetErrorCode() == 0;
}

bool write_mesh_throwing(const TriangleMesh& mesh, const fs::path& path, MeshFormat format) {
  const vtkNew<vtkPolyData> data = poly_data_of(mesh);
  switch (format) {
    case MeshFormat::kStl: {
      vtkNew<vtkSTLWriter> writer;
      writer->SetFileTypeToBinary();
      writer->SetHeader("trocar surface. SPACE=LPS");  // 3D Slicer reads the frame from this header.
      return run_writer(*writer, *data, path);
    }
    case MeshFormat::kVtp: {
      vtkNew<vtkXMLPolyDataWriter> writer;
      return run_writer(*writer, *data, path);
    }
  }
  return false;
}

}  // namespace

Result<TriangleMesh> read_mesh(const fs::path& path, const fs::path& inside) {
  vtkObject::SetGlobalWarningDisplay(0);
  const DecimalPoint decimal_point;
  TROCAR_TRY(const MeshFormat format, find_mesh_format(path));
  TROCAR_TRY(const InputFile file, InputFile::open(path, FileKind::kMesh, inside));
  TROCAR_TRY(const std::string bytes, file.read_all());
  TROCAR_TRY_STATUS(check_bytes(bytes, format, path.string()));
  try {
    return read_mesh_throwing(file, bytes, format);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory to read the surface", path.string(), "close other programs");
  } catch (const std::exception&) {
    return fail("damaged or not a surface", path.string(), kExportSurfaceAgain);
  }
}

Status write_mesh(const TriangleMesh& mesh_P, const fs::path& path) {
  vtkObject::SetGlobalWarningDisplay(0);
  const DecimalPoint decimal_point;
  TROCAR_TRY(const MeshFormat format, find_mesh_format(path));
  return write_atomically(path, [&](const fs::path& temporary) -> Status {
    try {
      if (write_mesh_throwing(mesh_P, temporary, format)) return {};
    } catch (const std::exception&) {
      // Reported below.
    }
    return fail("the surface cannot be written", path.string(), "check the disk space and the permissions");
  });
}

}  // namespace trocar::io
