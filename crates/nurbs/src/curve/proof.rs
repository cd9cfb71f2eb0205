//! Bounds of derivatives and of the distance between a piece of a curve and its chord.
