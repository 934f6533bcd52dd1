#include "store/xdmf.hpp"

#include <fmt/format.h>

#include "store/file/temporary_file.hpp"
#include "store/hdf5/dataset.hpp"
#include "store/input_file.hpp"
#include "text/utf8.hpp"

namespace fw::store {

namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text::printable_line(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// One frame of a dataset of shape (F, n, 3) as a hyperslab: start, stride and count of the three axes.
std::string frame_of(const std::string& file, const char* dataset, std::size_t frame, const Shape& shape) {
  return fmt::format(
      "          <DataItem ItemType=\"HyperSlab\" Dimensions=\"{1} 3\">\n"
      "            <DataItem Dimensions=\"3 3\" NumberType=\"Int\" Format=\"XML\">{2} 0 0 1 1 1 1 {1} "
      "3</DataItem>\n"
      "            <DataItem Dimensions=\"{0} {1} 3\" NumberType=\"Float\" Precision=\"8\" Format=\"HDF\">"
      "{3}:/trajectory/{4}</DataItem>\n"
      "          </DataItem>\n",
      shape[0], shape[1], frame, file, dataset);
}

std::string topology(const std::string& file, hsize_t springs, hsize_t particles) {
  if (springs == 0) {
    return fmt::format(
        "        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\"/>\n",
        particles);
  }
  return fmt::format(
      "        <Topology TopologyType=\"Polyline\" NumberOfElements=\"{0}\" NodesPerElement=\"2\">\n"
      "          <DataItem Dimensions=\"{0} 2\" NumberType=\"Int\" Precision=\"4\" Format=\"HDF\">"
      "{1}:/system/springs</DataItem>\n"
      "        </Topology>\n",
      springs, file);
}

}  // namespace

std::filesystem::path write_xdmf(const std::filesystem::path& h5_path) {
  const LibraryLock lock;
  const InputFile input(h5_path);
  if (!has_link(input.id(), "trajectory")) {
    throw InputError(
        fmt::format("\"{}\" holds no trajectory (its kind is \"{}\")", h5_path.string(), input.kind()));
  }
  Shape shape, springs;
  std::vector<double> times;
  try {
    const Handle trajectory = open_group(input.id(), "trajectory");
    shape = dataset_shape(trajectory, "position");
    springs = dataset_shape(open_group(input.id(), "system"), "springs");
    times = std::get<std::vector<double>>(read_dataset(trajectory, "time").values);
    if (shape.size() != 3 || shape[2] != 3 || springs.size() != 2 || times.size() != shape[0]) {
      throw LibraryError("its datasets do not fit together");
    }
  } catch (const LibraryError& error) {
    throw InputError(fmt::format("\"{}\" is damaged: {}", h5_path.string(), error.what()));
  }

  std::filesystem::path target = h5_path;
  target.replace_extension(".xdmf");
  TemporaryFile out(target);
  std::uint64_t offset = 0;
  const auto write = [&](const std::string& text) {
    out.file()->write(offset, text.data(), text.size());
    offset += text.size();
    out.check();
  };
  const std::string file = escaped(h5_path.filename().string());
  write(
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
      "<Xdmf Version=\"3.0\">\n"
      "  <Domain>\n"
      "    <Grid Name=\"trajectory\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  for (std::size_t frame = 0; frame < times.size(); ++frame) {
    write(
        fmt::format("      <Grid Name=\"frame {}\" GridType=\"Uniform\">\n"
                    "        <Time Value=\"{}\"/>\n"
                    "{}"
                    "        <Geometry GeometryType=\"XYZ\">\n{}        </Geometry>\n"
                    "        <Attribute Name=\"velocity\" AttributeType=\"Vector\" Center=\"Node\">\n"
                    "{}        </Attribute>\n"
                    "      </Grid>\n",
                    frame, times[frame], topology(file, springs[0], shape[1]),
                    frame_of(file, "position", frame, shape), frame_of(file, "velocity", frame, shape)));
  }
  write("    </Grid>\n  </Domain>\n</Xdmf>\n");
  out.publish();
  return target;
}

}  // namespace fw::store
