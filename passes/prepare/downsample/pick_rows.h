/* How one pixel of a 2x2 block is picked; of every variant of this slot that does it. */
#line 302
SPEC(bool,  edges,      true, 0, 1, "1", "Mafia III talk, G-buffer down-sampling", "discard the minority side of a depth discontinuity; off: take any pixel")
CHOICE2(tie, split, near, split, "GTA V article, stippled alpha; chosen by measuring", "two pixels on either side: near takes the near ones; split does too for an edge, but where the pairs are diagonals, as in stippled foliage, every other block takes the far ones, so that both surfaces have samples")
SPEC(bool,  alternate,  true, 0, 1, "1", "Mafia III talk, G-buffer down-sampling", "take another pixel of the block in each frame; off: the first that remains")
PUSH(float, edge_depth, 0.05, 0.0, 10.0, "1", "chosen by measuring", "relative depth difference that makes a discontinuity")
