#pragma once
// OpenVDB without the code of the trees that the engine makes: every file that makes one would otherwise compile all its virtual
// functions, 5 seconds for each type of value. openvdb_trees.cpp compiles them once.

#include <openvdb/openvdb.h>

namespace openvdb::OPENVDB_VERSION_NAME::tree {

extern template class Tree<FloatTree::RootNodeType>;
extern template class Tree<Vec3STree::RootNodeType>;

}  // namespace openvdb::OPENVDB_VERSION_NAME::tree
