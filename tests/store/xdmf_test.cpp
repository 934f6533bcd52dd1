#include "store/xdmf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "samples.hpp"
#include "scratch_directory.hpp"
#include "store/study_file.hpp"

namespace fw::store::test {
namespace {

/// Reads the file as VTK does: resolves every reference, applies the hyperslabs, prints what it found.
constexpr const char* reader = R"(
import h5py, os, sys
import xml.etree.ElementTree as xml
path = sys.argv[1]
root = xml.parse(path).getroot()
assert root.tag == 'Xdmf'
def numbers(text): return [int(word) for word in text.split()]
def load(item):
    dims = tuple(numbers(item.get('Dimensions')))
    if item.get('ItemType') == 'HyperSlab':
        slab, data = list(item)
        assert numbers(slab.get('Dimensions')) == [3, 3]
        start, stride, count = (numbers(slab.text)[i:i + 3] for i in (0, 3, 6))
        assert stride == [1, 1, 1]
        values = load(data)[tuple(slice(s, s + c) for s, c in zip(start, count))]
        return values.reshape(dims)
    name, dataset = item.text.strip().rsplit(':', 1)
    data = h5py.File(os.path.join(os.path.dirname(path), name), 'r')[dataset]
    assert data.shape == dims, (dataset, data.shape, dims)
    assert data.dtype.itemsize == int(item.get('Precision'))
    assert data.dtype.kind == {'Float': 'f', 'Int': 'i'}[item.get('NumberType')]
    return data[...]
series = root.find('Domain/Grid')
assert series.get('GridType') == 'Collection' and series.get('CollectionType') == 'Temporal'
for grid in series.findall('Grid'):
    position = load(grid.find('Geometry/DataItem'))
    velocity = load(grid.find('Attribute/DataItem'))
    assert grid.find('Attribute').get('AttributeType') == 'Vector' and position.shape == velocity.shape
    topology = grid.find('Topology')
    count = int(topology.get('NumberOfElements'))
    if topology.get('TopologyType') == 'Polyline':
        springs = load(topology.find('DataItem'))
        assert springs.shape == (count, 2) and springs.max() < len(position)
    else:
        assert topology.get('TopologyType') == 'Polyvertex' and count == len(position)
    print(topology.get('TopologyType'), count, grid.find('Time').get('Value'), position[0, 0], velocity[-1, 2])
)";

TEST(Xdmf, RefersToEveryFrameAsVtkReadsIt) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a & \"b\" <ü>.h5", 3, 3);
  const auto path = write_xdmf(scratch / "a & \"b\" <ü>.h5");
  EXPECT_EQ(path, scratch / "a & \"b\" <ü>.xdmf");
  EXPECT_EQ(run_python(reader, {path.string()}),
            "Polyline 2 0 0.0 0.017\n"
            "Polyline 2 0.5 1.0 1.017\n"
            "Polyline 2 1 2.0 2.017\n");
}

TEST(Xdmf, WithoutSpringsThereArePoints) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 1, 2);
  EXPECT_EQ(run_python(reader, {write_xdmf(scratch / "a.h5").string()}),
            "Polyvertex 1 0 0.0 0.005\nPolyvertex 1 0.5 1.0 1.005\n");
}

TEST(Xdmf, RefusesWhatIsNoTrajectory) {
  const ScratchDirectory scratch;
  write_study(scratch / "a.h5", "", sample_study(1));
  EXPECT_THAT([&] { write_xdmf(scratch / "a.h5"); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("holds no trajectory")));
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("a.h5"));
}

}  // namespace
}  // namespace fw::store::test
