#pragma once

#include <string>

#include "store/scratch_directory.hpp"

namespace fw::app::test {

/// Runs Python lines with `f`, `g`, … bound to the HDF5 files; what they print. The test fails if they do.
inline std::string inspect(const std::string& lines, const std::vector<std::string>& files) {
  const std::string head =
      "import sys, h5py, numpy as np\n"
      "f, g = (h5py.File(p, 'r') for p in (sys.argv[1:3] * 2)[:2])\n"
      "def same(a, b):\n"
      "  names = []\n"
      "  a.visititems(lambda n, o: names.append(n) if isinstance(o, h5py.Dataset) else None)\n"
      "  others = []\n"
      "  b.visititems(lambda n, o: others.append(n) if isinstance(o, h5py.Dataset) else None)\n"
      "  names = [n for n in names if not n.endswith('seconds')]\n"
      "  others = [n for n in others if not n.endswith('seconds')]\n"
      "  assert names == others and len(names) > 3, (names, others)\n"
      "  for n in names:\n"
      "    x, y = a[n][()], b[n][()]\n"
      "    assert np.shape(x) == np.shape(y) and np.asarray(x).dtype == np.asarray(y).dtype, n\n"
      "    if np.asarray(x).dtype == object: assert np.all(x == y), n\n"
      "    else: assert np.asarray(x).tobytes() == np.asarray(y).tobytes(), n\n"
      "  return len(names)\n";
  return store::test::run_python(head + lines, files);
}

}  // namespace fw::app::test
