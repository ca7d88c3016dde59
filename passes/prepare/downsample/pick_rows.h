/* How one pixel of a 2x2 block is picked. */
#line 302
SPEC(bool,  edges,      true, 0, 1, "1", "Mafia III talk, G-buffer down-sampling", "discard the pixels on the minority side of a depth discontinuity; off: any pixel may be picked")
CHOICE2(tie, split, near, split, "GTA V article, stippled alpha; chosen by measuring", "when two pixels lie on either side of a discontinuity. near: pick from the near ones; split: the same at an edge, but where the pairs are diagonals, as in stippled foliage, every other block picks from the far ones, so that both surfaces are sampled")
SPEC(bool,  alternate,  true, 0, 1, "1", "Mafia III talk, G-buffer down-sampling", "pick a different pixel of the block each frame; off: the first remaining one")
PUSH(float, edge_depth, 0.05, 0.0, 10.0, "1", "chosen by measuring", "relative depth difference that counts as a discontinuity")
