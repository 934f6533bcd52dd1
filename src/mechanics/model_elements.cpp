#include "mechanics/model_elements.hpp"

namespace fw::mechanics {

template class AssemblyOf<ElementBatch>;

}  // namespace fw::mechanics
