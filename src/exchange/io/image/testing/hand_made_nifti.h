#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

namespace trocar::testing {

/// Fields of a hand-made NIfTI-1 header, as the standard numbers its bytes.
struct HandMadeNifti {
  std::string bytes = std::string(352, '\0');

  HandMadeNifti() {
    put<std::int32_t>(0, 348);
    put<std::int16_t>(254, 1);  // sform: scanner coordinates
    put<float>(108, 352.0F);    // voxels follow at once
    std::memcpy(bytes.data() + 344, "n+1", 4);
  }
  template <class T>
  void put(std::size_t offset, T value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
  }
  void put_sizes(std::initializer_list<int> sizes) {
    put(40, static_cast<std::int16_t>(sizes.size()));
    std::size_t offset = 42;
    for (const int size : sizes) put(offset, static_cast<std::int16_t>(size)), offset += 2;
  }
  void put_type(std::int16_t code, std::int16_t bits) { put(70, code), put(72, bits); }
  void put_spacing(float x, float y, float z) { put(80, x), put(84, y), put(88, z); }
  /// Rows of the matrix index -> RAS mm.
  void put_sform(const std::array<float, 12>& rows) {
    for (std::size_t n = 0; n < rows.size(); ++n) put(280 + 4 * n, rows[n]);
  }
  template <class T>
  void add_voxels(const std::vector<T>& voxels) {
    bytes.append(reinterpret_cast<const char*>(voxels.data()), voxels.size() * sizeof(T));
  }
};

/// 3 x 2 x 2 voxels at 2 x 3 x 4 mm, first voxel at RAS (10, 20, 30), axes towards right, anterior, superior.
template <class T>
HandMadeNifti small_nifti(std::int16_t code, std::vector<T> voxels) {
  HandMadeNifti nifti;
  nifti.put_sizes({3, 2, 2});
  nifti.put_type(code, static_cast<std::int16_t>(8 * sizeof(T)));
  nifti.put_spacing(2, 3, 4);
  nifti.put_sform({2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30});
  nifti.add_voxels(voxels);
  return nifti;
}

}  // namespace trocar::testing
