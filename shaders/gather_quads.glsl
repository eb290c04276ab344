// Part of gather.comp, whose buffers and constants it reads: the quads of four blocks that a sample interpolates between.
#ifndef GATHER_QUADS_GLSL
#define GATHER_QUADS_GLSL

// On lavapipe, texels are faster than addresses.
uvec2 mediumQuad(int quad) {
  if (!kPieces) return texelFetch(mediumQuads, quad).xy;
  return MediumPiece(frame.axes[kAxis].mediumPieces[quad >> kPieceLog2]).values[quad & kPieceMask];
}

uvec4 sourceQuad(int quad) {
  if (!kPieces) return texelFetch(sourceQuads, quad);
  return SourcePiece(frame.axes[kAxis].sourcePieces[quad >> kPieceLog2]).values[quad & kPieceMask];
}

uvec4 towardsQuad(int quad) {
  if (!kPieces) return texelFetch(towardsQuads, quad);
  return SourcePiece(frame.axes[kAxis].towardsPieces[quad >> kPieceLog2]).values[quad & kPieceMask];
}

uvec2 lightQuad(int slot, int quad) {
  if (kPieces) return MediumPiece(frame.axes[kAxis].lightPieces[slot][quad >> kPieceLog2]).values[quad & kPieceMask];
  switch (slot) {
    case 0: return texelFetch(lightQuads0, quad).xy;
    case 1: return texelFetch(lightQuads1, quad).xy;
    case 2: return texelFetch(lightQuads2, quad).xy;
    case 3: return texelFetch(lightQuads3, quad).xy;
    case 4: return texelFetch(lightQuads4, quad).xy;
    case 5: return texelFetch(lightQuads5, quad).xy;
    default: return texelFetch(lightQuads6, quad).xy;
  }
}

#endif
