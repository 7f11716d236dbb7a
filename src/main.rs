use bdpt_explorer::{engine::*, scene::builtin, bdpt::*};
fn main(){
  let scene = std::sync::Arc::new(builtin::open("cornell").unwrap());
  let mut s = Session::new(Job{weighted_layers: true, ..Job::new(scene.clone())}).unwrap();
  while s.passes()<2 { s.step(std::time::Duration::from_secs(1)); }
  for _ in 0..4 { let t=std::time::Instant::now();
   
  println!("layers {:?}", t.elapsed());
  let t=std::time::Instant::now(); std::hint::black_box(s.image_without(&StrategySet::NONE));
  println!("image {:?}", t.elapsed()); 
  let t=std::time::Instant::now(); for i in 0..100 { std::hint::black_box(record(s.job(),[i*3,200],1)); }
  println!("record {:?}", t.elapsed()/100); 
  }
}
