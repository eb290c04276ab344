#include "engine/volume/openvdb_trees.h"

namespace openvdb::OPENVDB_VERSION_NAME::tree {

template class Tree<FloatTree::RootNodeType>;
template class Tree<Vec3STree::RootNodeType>;

}  // namespace openvdb::OPENVDB_VERSION_NAME::tree
