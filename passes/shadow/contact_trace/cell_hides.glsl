// Which rays through cells do not reach the sun. Next include of a pass with the rows of cell_rows.h.
bool hides(Result traced) { return traced.end == END_hit || (inside && traced.end == END_behind); }
