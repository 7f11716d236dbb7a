use bdpt_explorer::{engine::*, scene::builtin, bdpt::Settings};
fn main(){
  let scene = std::sync::Arc::new(builtin::open("cornell").unwrap());
  let pyr = std::env::args().nth(1).is_some();
  let mut s = Session::new(Job{settings: Settings{max_edges:10,..Default::default()}, weighted_layers: pyr, raw_layers: pyr, ..Job::new(scene)}).unwrap();
  while s.passes()<4 { s.step(std::time::Duration::from_secs(1)); }
  let st=s.stats(); let r=(st.rays_closest+st.rays_shadow) as f64;
  println!("{:.3} Mpairs/s/core {:.2} Mrays/s/core {:.1} rays/pair wall {:.2} cpu {:.2}", st.pairs as f64/st.cpu_seconds*1e-6, r/st.cpu_seconds*1e-6, r/st.pairs as f64, st.seconds, st.cpu_seconds);
}
