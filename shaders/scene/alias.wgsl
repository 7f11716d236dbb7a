// Choosing one of many by their weights: twin of src/scene/alias.rs.

// An index, by two numbers in [0, 1); 0 if the table is empty. The table begins at `first` and has `count` cells.
fn choose(first: u32, count: u32, u: vec2<f32>) -> u32 {
    let index = u32(u.x * f32(count));
    if index < count {
        let cell = load_alias_cell(first, index);
        if u.y >= cell.threshold {
            return cell.other;
        }
    }
    return index;
}
